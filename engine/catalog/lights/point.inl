// A point light: radiant intensity in W/sr, falling off with a polynomial of the distance.
// index: 0
// Source:   OpenGL 1.x lighting (constant, linear, quadratic attenuation); kc = kl = 0, kq = 1 is the inverse square law.
// Contract: attenuation is at most 1 / kMinAttenuation, wherever the light is (HARD-CASES S3); a point in the light itself (within
//           kMinLength) has no direction to it and gets nothing; finite for all finite input.
namespace lights::point {
template <class F> SPANRAY_FORMULA Incidence<F> incidence(const LightLanes<F>& light, const Vec3<F>& position) {
  const Vec3<F> to_light = light.position - position;
  const F distance = length(to_light);
  const F falloff = mul_add(mul_add(light.attenuation.z, distance, light.attenuation.y), distance, light.attenuation.x);
  // max_ gives its second argument for NaN: 0 * infinity at distances beyond sqrt(FLT_MAX), where the direction is zero as well.
  return {divide_or_zero(to_light, distance), number<F>(1.0f) / max_(falloff, number<F>(kMinAttenuation))};
}
// Ends 2^-16 of the distance before the light, so that a lamp modelled around the light or touching it does not shadow it
// by rounding (of the direction, 2^-24 of each coordinate, and of t).
template <class F> SPANRAY_FORMULA Segment<F> segment(const LightLanes<F>& light, const Vec3<F>& origin) {
  return {light.position - origin, number<F>(1.0f - 0x1p-16f)};
}
}  // namespace lights::point
