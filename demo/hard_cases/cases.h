// The measuring functions behind hard_cases.cpp, by family. Each says beside its definition what it measures.
#pragma once
#include "hard_case.h"

namespace spanray::hard {

// coverage.cpp: triangles on the screen
Finding r1_vertices_on_centers(const Effort& effort);
Finding r2_shared_edges(const Effort& effort);
Finding r4_fan(const Effort& effort);
Finding r5_slivers(const Effort& effort);
Finding r8_shifts(const Effort& effort);
Tally fuzz_coverage(const Effort& effort, int full, int few);
void check_no_area(const Effort& effort, Tally& triangles);

// clipping.cpp: triangles of the world, to the guard band and the near plane
Finding r3_clipped_edges(const Effort& effort);
Finding r9_extents(const Effort& effort);
Finding r10_huge_vertices(const Effort& effort);
Finding r11_behind_the_eye(const Effort& effort);
Finding r12_depth_zero(const Effort& effort);
Finding r13_edges_from_both_sides(const Effort& effort);
Finding r14_bad_vertices(const Effort& effort);

// meshes.cpp: whole meshes, pictures of all sizes
Finding r6_no_area(const Effort& effort);
Finding r7_sub_pixel_mesh(const Effort& effort);
Finding r15_t_junctions(const Effort& effort);
Finding r16_small_pictures(const Effort& effort);
Finding r17_one_hash(const Effort& effort);

// depth.cpp
Finding d1_pairs(const Effort& effort);
Finding d2_coplanar_copies(const Effort& effort);
Finding d3_decals(const Effort& effort);
Finding d4_edge_on(const Effort& effort);
Finding d5_crossing_planes(const Effort& effort);

// interpolation.cpp
Finding i1_perspective(const Effort& effort);
Finding i2_far_pixel(const Effort& effort);
Finding i3_equal_attributes(const Effort& effort);
Finding i4_opposed_normals(const Effort& effort);
Finding i5_zero_uv_area(const Effort& effort);

// texture.cpp
Finding i6_level_of_detail(const Effort& effort);
Finding i7_huge_uv(const Effort& effort);
Finding i8_blit(const Effort& effort);

// shading.cpp
Finding s1_powers(const Effort& effort);
Finding s2_zero_half_vector(const Effort& effort);
Finding s3_light_on_surface(const Effort& effort);
Finding s4_fresnel(const Effort& effort);
Finding s5_albedo(const Effort& effort);
Finding s6_gouraud(const Effort& effort);
Finding s7_bump(const Effort& effort);
Finding s8_terminator(const Effort& effort);

// rays.cpp: closed meshes, scales, distances
Finding y1_watertight(const Effort& effort);
Finding y2_scales(const Effort& effort);
Finding y3_far_away(const Effort& effort);
Finding y6_flat_boxes(const Effort& effort);
Finding y7_leaving_surfaces(const Effort& effort);
Finding y10_far_sphere(const Effort& effort);

// ray_answers.cpp: against brute force
Finding y4_zeros(const Effort& effort);
Finding y5_brute_force(const Effort& effort);
Finding y8_coincident(const Effort& effort);
Finding y9_bad_rays(const Effort& effort);
Finding y14_equal_centroids(const Effort& effort);

// pictures.cpp: whole frames
Finding y11_critical_angle(const Effort& effort);
Finding y12_mirror_corridor(const Effort& effort);
Finding y13_raster_against_rays(const Effort& effort);
Finding t1_crossing_panes(const Effort& effort);

// output.cpp
Finding t2_coplanar_layers(const Effort& effort);
Finding t3_many_layers(const Effort& effort);
Finding t4_screen_door(const Effort& effort);
Finding t5_shared_diagonal(const Effort& effort);
Finding o1_srgb(const Effort& effort);
Finding o2_not_finite(const Effort& effort);
Finding o3_straight_alpha(const Effort& effort);

}  // namespace spanray::hard
