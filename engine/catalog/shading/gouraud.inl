// Gouraud shading: light is evaluated at the corners and interpolated.
// index: 1
// Source:   Gouraud 1971, "Continuous Shading of Curved Surfaces".
// Input:    weights in [0, 1] with sum 1.
namespace shading::gouraud {
template <class F> SPANRAY_FORMULA F interpolate(const Vec3<F>& weight, F a, F b, F c) {
  return mul_add(weight.x, a, mul_add(weight.y, b, weight.z * c));
}
// Light at a corner is evaluated for the side of the surface that the light is on, and stored with the sign of n.l. Seen from
// the side of the normal (front), positive values are lit; from behind, negative ones: one evaluation serves both sides.
template <class F, class M> SPANRAY_FORMULA F seen_from(M front, F corner_light) {
  return max_(select(front, corner_light, -corner_light), number<F>(0.0f));
}
}  // namespace shading::gouraud
