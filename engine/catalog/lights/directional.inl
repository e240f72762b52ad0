// Light from infinitely far away, along one direction: intensity is the irradiance of a surface that faces it, W/m^2.
// index: 1
namespace lights::directional {
template <class F> SPANRAY_FORMULA Incidence<F> incidence(const LightLanes<F>& light, const Vec3<F>&) {
  return {-light.direction, number<F>(1.0f)};
}
template <class F> SPANRAY_FORMULA Segment<F> segment(const LightLanes<F>& light, const Vec3<F>&) {
  return {-light.direction, number<F>(kInfinity)};
}
}  // namespace lights::directional
