// The MTL model (illum 1 and 2): Lambert plus a cosine lobe about the half-way vector, divided by pi so that intensities are physical.
// index: 0
// Source:   Blinn 1977, "Models of Light Reflection for Computer Synthesized Pictures"; the MTL format, illum 2.
// Input:    n_l > 0; n_h in [0, 1]; shininess in [0, 1e4].   Output: reflectance times cosine, 1/sr.
// Contract: 0 where there is no half vector and shininess > 0. Error <= 8 ulp (diffuse), (8 + 4 shininess) ulp and that of pow_
//           (specular): the power magnifies the error of n_h. Fast powers: that of fast_pow_.
namespace reflectance::blinn_phong {
template <class F> SPANRAY_FORMULA F diffuse(const Cosines<F>& c) { return c.n_l * number<F>(0.318309886f); }
template <class F> SPANRAY_FORMULA F specular(const Cosines<F>& c) {
  // pow(0, 0) is 1, but a half vector that does not exist reflects nothing whatever the exponent.
  const F zero = number<F>(0.0f);
  return select(c.n_h > zero, highlight_power(c, c.n_h, c.shininess) * number<F>(0.318309886f), zero);
}
}  // namespace reflectance::blinn_phong
