// Perfectly diffuse reflection (MTL illum 1 without a highlight).
// index: 1
// Source:   Lambert 1760, "Photometria".
// Input:    n_l > 0.   Output: reflectance times cosine, 1/sr; no specular part.
namespace reflectance::lambert {
template <class F> SPANRAY_FORMULA F diffuse(const Cosines<F>& c) { return c.n_l * number<F>(0.318309886f); }
template <class F> SPANRAY_FORMULA F specular(const Cosines<F>&) { return number<F>(0.0f); }
}  // namespace reflectance::lambert
