// Flat shading: a face is lit once, at its centroid, with the face normal.
// index: 0
// Source:   Bouknight 1970, "A procedure for generation of three-dimensional half-toned computer graphics presentations".
namespace shading::flat {
template <class F> SPANRAY_FORMULA F centroid(F a, F b, F c) { return (a + b + c) / number<F>(3.0f); }
}  // namespace shading::flat
