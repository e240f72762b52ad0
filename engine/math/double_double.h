// Numbers of twice the precision of double, as unevaluated sums: for differences that cancel almost wholly. Plain IEEE
// arithmetic, so the same bits on every machine, with or without a fused multiply-add.
#pragma once

namespace spanray {

struct DoubleDouble {
  double hi, lo;  // of results: hi is the nearest double but for one ulp at most
};

// a + b exactly. Source: Knuth 1969, "The Art of Computer Programming", volume 2, 4.2.2.
inline DoubleDouble two_sum(double a, double b) {
  const double sum = a + b, other = sum - a;
  return {sum, (a - (sum - other)) + (b - other)};
}

// a * b exactly, for |a|, |b| < 2^995 and products that are 0 or above 2^-969.
// Source: Dekker 1971, "A Floating-Point Technique for Extending the Available Precision"; Veltkamp's splitting.
inline DoubleDouble two_product(double a, double b) {
  constexpr double kSplit = 0x1p27 + 1;
  const double a_big = kSplit * a, a_hi = a_big - (a_big - a), a_lo = a - a_hi;
  const double b_big = kSplit * b, b_hi = b_big - (b_big - b), b_lo = b - b_hi;
  const double product = a * b;
  return {product, ((a_hi * b_hi - product) + a_hi * b_lo + a_lo * b_hi) + a_lo * b_lo};
}

// a + b, off by less than 2^-101 (|a| + |b|).
inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
  const DoubleDouble sum = two_sum(a.hi, b.hi);
  return two_sum(sum.hi, sum.lo + (a.lo + b.lo));
}
inline DoubleDouble operator-(const DoubleDouble& a) { return {-a.hi, -a.lo}; }

// a * b - c * d, off by less than 2^-99 (|a b| + |c d|).
inline DoubleDouble difference_of_products(const DoubleDouble& a, const DoubleDouble& b, const DoubleDouble& c,
                                           const DoubleDouble& d) {
  const DoubleDouble ab = two_product(a.hi, b.hi), cd = two_product(c.hi, d.hi), difference = two_sum(ab.hi, -cd.hi);
  const double low = (a.hi * b.lo + a.lo * b.hi) - (c.hi * d.lo + c.lo * d.hi);
  return two_sum(difference.hi, difference.lo + ((ab.lo - cd.lo) + low));
}

}  // namespace spanray
