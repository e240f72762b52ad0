// Cartoon shading: two tones of diffuse light with a hard edge between them, and no highlight.
// Input:    n_l > 0.   Output: reflectance times cosine, 1/sr.
namespace reflectance::toon {
template <class F> SPANRAY_FORMULA F diffuse(const Cosines<F>& c) {
  return select(c.n_l > number<F>(0.5f), number<F>(0.3f), number<F>(0.1f));
}
template <class F> SPANRAY_FORMULA F specular(const Cosines<F>&) { return number<F>(0.0f); }
}  // namespace reflectance::toon
