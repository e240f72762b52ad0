// The operations of math/double_double.h for numbers of one kind, so that scalar code and lanes have the same ones in the same order,
// and so the same bits. Where it is included, `Number` is that kind, number(double) makes one, SPANRAY_DOUBLE_DOUBLE stands before functions.

struct DoubleDouble {
  Number hi, lo;  // of results: hi is the nearest double but for one ulp at most
};

// a + b exactly. Source: Knuth 1969, "The Art of Computer Programming", volume 2, 4.2.2.
SPANRAY_DOUBLE_DOUBLE DoubleDouble two_sum(Number a, Number b) {
  const Number sum = a + b, other = sum - a;
  return {sum, (a - (sum - other)) + (b - other)};
}

// a * b exactly, for |a|, |b| < 2^995 and products that are 0 or above 2^-969.
// Source: Dekker 1971, "A Floating-Point Technique for Extending the Available Precision"; Veltkamp's splitting.
SPANRAY_DOUBLE_DOUBLE DoubleDouble two_product(Number a, Number b) {
  const Number split = number(0x1p27 + 1);
  const Number a_big = split * a, a_hi = a_big - (a_big - a), a_lo = a - a_hi;
  const Number b_big = split * b, b_hi = b_big - (b_big - b), b_lo = b - b_hi;
  const Number product = a * b;
  return {product, ((a_hi * b_hi - product) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo};
}

// a + b, off by less than 2^-101 (|a| + |b|).
SPANRAY_DOUBLE_DOUBLE DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble sum = two_sum(a.hi, b.hi);
  return two_sum(sum.hi, sum.lo + (a.lo + b.lo));
}
SPANRAY_DOUBLE_DOUBLE DoubleDouble operator-(const DoubleDouble& a) { return {-a.hi, -a.lo}; }

// a * b - c * d, off by less than 2^-99 (|a b| + |c d|).
SPANRAY_DOUBLE_DOUBLE DoubleDouble difference_of_products(const DoubleDouble& a, const DoubleDouble& b, const DoubleDouble& c,
                                                          const DoubleDouble& d) {
  const DoubleDouble ab = two_product(a.hi, b.hi), cd = two_product(c.hi, d.hi), difference = two_sum(ab.hi, -cd.hi);
  const Number low = (a.hi * b.lo + a.lo * b.hi) - (c.hi * d.lo + c.lo * d.hi);
  return two_sum(difference.hi, difference.lo + ((ab.lo - cd.lo) + low));
}

#undef SPANRAY_DOUBLE_DOUBLE
