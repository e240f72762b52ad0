// The nouns that the formulas of the catalog speak of, over a lane type F: F32 (16, 8, 4 or 1 lanes), or float and double in
// tests. A formula file is pure mathematics: it may use + - * / and unary minus of F, comparisons, select, min_, max_, sqrt_,
// pow_, mul_add and number<F>(constant), and what stands here. Formula files and this one have no include guards; they are
// included inside a namespace `formula` within the target region (catalog/formulas-inl.h).
//
// What a formula file must define, in namespace KIND::NAME (NAME.inl in folder KIND):
//   reflectance   F diffuse(const Cosines<F>&), F specular(const Cosines<F>&): reflectance times cosine, 1/sr; the renderer multiplies
//                 the first by Kd, the second by Ks. Asked only where n_l > 0; both finite and not negative there.
//   lights        Incidence<F> incidence(const LightLanes<F>&, Vec3<F> position)
//                 Segment<F> segment(const LightLanes<F>&, Vec3<F> origin)
//   shading, transparency: as their users need.

template <class F> struct Vec3 { F x, y, z; };
template <class F> SPANRAY_FORMULA Vec3<F> operator+(const Vec3<F>& a, const Vec3<F>& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class F> SPANRAY_FORMULA Vec3<F> operator-(const Vec3<F>& a, const Vec3<F>& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class F> SPANRAY_FORMULA Vec3<F> operator-(const Vec3<F>& a) { return {-a.x, -a.y, -a.z}; }
template <class F> SPANRAY_FORMULA Vec3<F> operator*(F s, const Vec3<F>& a) { return {s * a.x, s * a.y, s * a.z}; }
template <class F> SPANRAY_FORMULA F dot(const Vec3<F>& a, const Vec3<F>& b) {
  return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z));
}
template <class F> SPANRAY_FORMULA F length(const Vec3<F>& a) { return sqrt_(dot(a, a)); }
// Lengths below this count as zero: their squares are subnormal, so they have lost digits.
inline constexpr float kMinLength = 0x1p-62f;
// a / length, and zero where the length is: a direction that does not exist lights nothing.
template <class F> SPANRAY_FORMULA Vec3<F> divide_or_zero(const Vec3<F>& a, F length) {
  const F zero = number<F>(0.0f);
  const auto exists = length >= number<F>(kMinLength);
  const F inverse = number<F>(1.0f) / select(exists, length, number<F>(1.0f));
  return {select(exists, a.x * inverse, zero), select(exists, a.y * inverse, zero), select(exists, a.z * inverse, zero)};
}

// Cosines between the unit vectors n (shading normal), l (to the light), v (to the viewer), h (half-way between l and v).
// n_h is in [0, 1], and 0 where there is no half-way direction.
// fast_powers: the frame asks for them (Settings::powers).
template <class F> struct Cosines {
  F n_l, n_v, n_h, l_h, l_v, shininess;
  bool fast_powers = false;
};
// base^exponent of a highlight, as the frame asks for it: base in [0, 1], exponent in [0, 1e4].
template <class F> SPANRAY_FORMULA F highlight_power(const Cosines<F>& c, F base, F exponent) {
  return c.fast_powers ? fast_pow_(base, exponent) : highlight_pow_(base, exponent);
}

// |l + v| below which l and v count as opposite: h is then mostly rounding error (HARD-CASES S2).
inline constexpr float kMinHalfLength = 1e-5f;

// All but the half-way vector, which only highlights need: n_h = l_h = 0.
template <class F>
SPANRAY_FORMULA Cosines<F> cosines(const Vec3<F>& n, const Vec3<F>& l, const Vec3<F>& v, F n_l, F shininess,
                                   bool fast_powers = false) {
  const F zero = number<F>(0.0f);
  return {n_l, dot(n, v), zero, zero, dot(l, v), shininess, fast_powers};
}
template <class F>
SPANRAY_FORMULA void add_half_way(Cosines<F>& c, const Vec3<F>& n, const Vec3<F>& l, const Vec3<F>& v) {
  const F zero = number<F>(0.0f), one = number<F>(1.0f);
  const Vec3<F> sum = l + v;
  const F sum_length = length(sum);
  const auto exists = sum_length > number<F>(kMinHalfLength);
  c.n_h = select(exists, min_(max_(dot(n, sum) / sum_length, zero), one), zero);
  c.l_h = select(exists, dot(l, sum) / sum_length, zero);
}

// One light, the same in every lane; fields as in scene/scene_data.h.
template <class F> struct LightLanes { Vec3<F> position, direction, attenuation; };
// Light as it arrives at a point: unit vector toward the light (zero if there is none), and E = intensity * attenuation, the
// irradiance of a surface that faces it.
template <class F> struct Incidence { Vec3<F> direction; F attenuation; };
// What must be free for the light to arrive: origin + t * direction, 0 <= t <= t_max.
template <class F> struct Segment { Vec3<F> direction; F t_max; };
