// Every formula of the catalog on the same inputs (tests/catalog_formulas_test.cpp); returns the number of results.
template <class F>
int evaluate_catalog(const F* in, F* out) {
  int n = 0;
  const Cosines<F> c = {in[0], in[1], in[2], in[3], in[4], in[5]};
#define SPANRAY_CATALOG_ENTRY(index, name)       \
  out[n++] = reflectance::name::diffuse(c);      \
  out[n++] = reflectance::name::specular(c);
#include "catalog_reflectance_list.inc"
#undef SPANRAY_CATALOG_ENTRY
  const LightLanes<F> light = {{in[6], in[7], in[8]}, {in[9], in[10], in[11]}, {in[0], in[1], in[2]}};
  const Vec3<F> p = {in[12], in[13], in[14]};
#define SPANRAY_CATALOG_ENTRY(index, name)                                                                    \
  {                                                                                                           \
    const Incidence<F> incidence = lights::name::incidence(light, p);                                         \
    const Segment<F> segment = lights::name::segment(light, p);                                               \
    for (const F& x : {incidence.direction.x, incidence.direction.y, incidence.direction.z, incidence.attenuation, \
                       segment.direction.x, segment.direction.y, segment.direction.z, segment.t_max})         \
      out[n++] = x;                                                                                           \
  }
#include "catalog_lights_list.inc"
#undef SPANRAY_CATALOG_ENTRY
  out[n++] = transparency::alpha::over(in[0], in[6], in[7]);
  out[n++] = shading::flat::centroid(in[6], in[7], in[8]);
  out[n++] = shading::gouraud::interpolate(Vec3<F>{in[0], in[1], in[2]}, in[6], in[7], in[8]);
  out[n++] = shading::gouraud::seen_from(in[9] > in[10], in[6]);
  Cosines<F> full = cosines(Vec3<F>{in[0], in[1], in[2]}, Vec3<F>{in[2], in[3], in[4]}, p, in[0], in[5]);
  add_half_way(full, Vec3<F>{in[0], in[1], in[2]}, Vec3<F>{in[2], in[3], in[4]}, p);
  for (const F& x : {full.n_v, full.n_h, full.l_h, full.l_v}) out[n++] = x;
  return n;
}
