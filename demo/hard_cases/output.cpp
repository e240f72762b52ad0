// Layers and bytes (T2 to T5, O1 to O3).
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "cases.h"
#include "image/encode.h"
#include "math/color.h"
#include "spanray/image.h"
#include "spanray/render.h"
#include "support/camera_at.h"
#include "support/layers.h"
#include "support/quad_frame.h"
#include "support/raster_front_end.h"
#include "support/raster_soup.h"

namespace spanray::hard {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
uint32_t bits(float f) { return std::bit_cast<uint32_t>(f); }
float from_bits(uint32_t b) { return std::bit_cast<float>(b); }
long double exact_decode(long double e) { return e <= 0.04045L ? e / 12.92L : std::pow((e + 0.055L) / 1.055L, 2.4L); }

void shuffle(std::vector<int>& place, TestRandom& random) {
  for (size_t i = place.size() - 1; i > 0; --i) std::swap(place[i], place[static_cast<size_t>(random.below(static_cast<int>(i) + 1))]);
}

}  // namespace

// Twenty layers of one depth in any order of the batch: blended by their ids, the lowest on top, with the same bits.
Finding t2_coplanar_layers(const Effort& effort) {
  TestRandom random(2);
  std::vector<int> place(20);
  std::iota(place.begin(), place.end(), 0);
  Tally orders;
  float by_hand = 0;
  for (int id = 19; id >= 0; --id) by_hand = 0.5f * static_cast<float>(id + 1) + 0.5f * by_hand;
  for (int trial = 0; trial < effort.count(3000, 300); ++trial) {
    Layers l(20, 1);
    for (int id = 0; id < 20; ++id) {
      const int i = place[static_cast<size_t>(id)];
      l.set(i, 3.0f, 0.5f, static_cast<float>(id + 1));
      l.fragments.primitive[i] = static_cast<uint32_t>(id);
    }
    l.run();
    orders.check(l.out.channel[0][0] == by_hand);
    shuffle(place, random);
  }
  return none_wrong(orders, "orders of submission", 300);
}

// Opaque stacks, and glassy ones where each layer is seen, against double.
Finding t3_many_layers(const Effort& effort) {
  TestRandom random(1);
  Worst codes;
  for (int trial = 0; trial < effort.count(2000, 100); ++trial) {
    const double top = trial % 2 != 0 ? 1.0 : 0.05;
    Layers l(256, 1);
    std::vector<int> by_t(256);
    for (int i = 0; i < 256; ++i) {
      const glm::dvec3 p = glm::dvec3(random.uniform(1, 2), random.uniform(0, top), random.uniform(0, 2));
      l.set(i, static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z));
    }
    l.out.channel[0][0] = l.out.channel[1][0] = l.out.channel[2][0] = 0.7f;
    std::iota(by_t.begin(), by_t.end(), 0);
    std::sort(by_t.begin(), by_t.end(),
              [&](int a, int b) { return l.fragments.t[a] != l.fragments.t[b] ? l.fragments.t[a] > l.fragments.t[b] : a > b; });
    double want = 0.7f, through = 1;
    for (const int i : by_t) {
      const double a = l.fragments.opacity[i];
      want = a * l.light.channel[0][static_cast<size_t>(i)] + (1 - a) * want, through *= 1 - a;
    }
    l.run();
    codes.add(255 * l.out.max_encoded_difference(0, glm::dvec3(want)));
    if (std::fabs(l.transmittance[0] - through) > through * 256 * 0x1p-23 + 1e-36) codes.add(INFINITY);
  }
  return within(codes, 1, "of 255", "stacks", 100);
}

// Accepted pixels of each 8 x 8 mask tile for all opacities in 1/256; then a frame of two screen-door soups with its objects in
// another order.
Finding t4_screen_door(const Effort& effort) {
  Tally tiles;
  for (const Isa isa : supported_isas())
    for (int n = 0; n <= 256; ++n) {
      const float opacity = static_cast<float>(n) / 256;
      auto t = quad_frame(material_of_kind(MaterialTransparency::kScreenDoor, opacity));
      t->frame.isa = isa;
      for (const int x0 : {0, 8, 72})
        for (const int y0 : {0, 40}) {
          int count = 0;
          for (int y = y0; y < y0 + 8; ++y) count += __builtin_popcount(accept_row(t->frame, 0, x0, y, 0xffu));
          tiles.check(count == static_cast<int>(std::floor(opacity * 64 + 0.5f)));
        }
    }
  std::vector<Material> materials = {material_of_kind(MaterialTransparency::kScreenDoor, 0.4f),
                                     material_of_kind(MaterialTransparency::kScreenDoor, 0.7f)};
  for (size_t m = 0; m < 2; ++m)
    for (int k = 0; k < 3; ++k) materials[m].emission[k] = 0.1f + 0.2f * static_cast<float>((m + static_cast<size_t>(k)) % 3);
  TestRandom random(4);
  std::vector<SoupTriangle> soup = random_soup(4, effort.count(2000, 400), 2);
  std::vector<int> place(soup.size());
  std::iota(place.begin(), place.end(), 0);
  uint64_t first = 0;
  for (int order = 0; order < 6; ++order) {
    std::vector<SoupTriangle> permuted;
    for (const int i : place) permuted.push_back(soup[static_cast<size_t>(i)]);
    Settings settings;
    settings.width = 320, settings.height = 200;
    Framebuffer out;
    Renderer renderer;
    const Scene scene(std::make_shared<SceneData>(make_test_scene(permuted, materials)));
    const bool rendered = static_cast<bool>(renderer.render(scene, camera_at({0, 0, 3}, {0.1, 0.2, 0}), settings, out));
    if (order == 0) first = hash_image(out.color);
    tiles.check(rendered && hash_image(out.color) == first, [] { return std::string("another order of objects, another picture"); });
    shuffle(place, random);
  }
  return none_wrong(tiles, "mask tiles and orders", 1500, "6 orders of " + grouped(soup.size()) + " triangles");
}

// Quads cut through pixel centers, of all sizes: one layer everywhere. And alpha 0 and 1 leave the bits of what is behind and before.
Finding t5_shared_diagonal(const Effort& effort) {
  Tally cases;
  TestRandom random(5);
  for (int n = 0; n < effort.count(400, 40); ++n) {
    // The camera sees [-1, 1] at z = 0 in 64 pixels: corners at centers.
    const int x0 = random.between(0, 30), y0 = random.between(0, 30), size = random.between(1, 32);
    const auto at = [&](int x, int y) { return glm::dvec3((x + 0.5) / 32 - 1, 1 - (y + 0.5) / 32, 0); };
    const glm::dvec3 a = at(x0, y0), b = at(x0 + size, y0), c = at(x0 + size, y0 + size), d = at(x0, y0 + size);
    Camera camera = camera_at({0, 0, 1}, {0, 0, 0});
    camera.fov_y_degrees = 90;
    const auto t = make_test_frame(make_test_scene({soup_triangle(a, c, b), soup_triangle(a, d, c)}, {translucent_material()}),
                                   camera, test_settings(64, 64));
    const std::vector<int> count = count_fragments(t->frame, run_front_end(t->frame).bins);
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        cases.check(count[static_cast<size_t>(y * 64 + x)] == int{x >= x0 && x < x0 + size && y >= y0 && y < y0 + size});
  }
  const float odd[] = {0.0f, -0.0f, kInf, 1e-45f, 3e38f, 0.1f};
  for (const float behind : odd)
    for (const float layer : odd)
      for (const float alpha : {0.0f, 1.0f}) {
        Layers l(1, 1);
        l.set(0, 1, alpha, layer);
        for (auto& c : l.out.channel) c[0] = behind;
        l.run();
        for (const auto& c : l.out.channel) cases.check(bits(c[0]) == bits(alpha == 0 ? behind : layer) && l.transmittance[0] == 1 - alpha);
      }
  return none_wrong(cases, "pixels and blends", 100000);
}

// Every code there and back, from 16-bit texels and from floats; every float from 2^-14 to 2 (or some of them): monotone, and
// each step within one float of where long double puts it.
Finding o1_srgb(const Effort& effort) {
  Tally values;
  for (int k = 0; k < 256; ++k) {
    const uint16_t texel = linear16_from_srgb8(static_cast<uint8_t>(k));
    values.check(texel == std::lround(65535 * exact_decode(k / 255.0L)) && srgb8_from_linear(texel / 65535.0f) == k &&
                     srgb8_from_linear(linear_from_srgb(static_cast<float>(k) / 255.0f)) == k,
                 [&] { return "code " + std::to_string(k); });
  }
  int code = 0;
  uint64_t swept = 0, wrong = 0;
  const uint32_t stride = effort.quick ? 37 : 1;
  for (uint32_t b = bits(0x1p-14f); b <= bits(2.0f); b += stride, ++swept) {
    const int next = srgb8_from_linear(from_bits(b));
    wrong += next < code, code = next;
  }
  values.add(wrong + (code != 255), swept);
  for (int k = 0; k < 255; ++k) {
    const long double step = exact_decode((k + 0.5L) / 255);
    const float first = srgb_encode_table().step[k];
    values.check(srgb8_from_linear(first) == k + 1 && srgb8_from_linear(from_bits(bits(first) - 1)) == k &&
                 first >= step * (1 - 0x1p-40L) && from_bits(bits(first) - 1) < step * (1 + 0x1p-40L));
  }
  return none_wrong(values, "values", 1000000);
}

// Through the row encoder of every instruction set.
Finding o2_not_finite(const Effort&) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> x = {
      nan,   -nan, from_bits(0x7fa00000),    -kInf, -1.0f, -0.0f, 0.0f, from_bits(1), -from_bits(1), 1.0f, 2.0f,
      3e38f, kInf, from_bits(bits(1.0f) - 1)};
  Tally values;
  for (const Isa isa : supported_isas()) {
    const float* const planes[3] = {x.data(), x.data(), x.data()};
    std::vector<uint8_t> rgba(4 * x.size());
    encode_row(isa, planes, static_cast<int>(x.size()), rgba.data());
    for (size_t i = 0; i < x.size(); ++i) {
      const uint8_t want = i < 9 ? 0 : 255;
      values.check(rgba[4 * i] == want && rgba[4 * i + 1] == want && rgba[4 * i + 2] == want && rgba[4 * i + 3] == 255 &&
                   srgb8_from_linear(x[i]) == want);
    }
  }
  return none_wrong(values, "values", 14);
}

// All 65,536 pairs: the nearest straight value, halves up; and premultiplying it again gives the first back.
Finding o3_straight_alpha(const Effort&) {
  Tally pairs;
  for (unsigned alpha = 0; alpha < 256; ++alpha)
    for (unsigned value = 0; value < 256; ++value) {
      const unsigned got = straight_from_premultiplied(static_cast<uint8_t>(value), static_cast<uint8_t>(alpha));
      const double want = alpha == 0 ? 0 : std::min(255.0, std::floor(255.0 * value / alpha + 0.5));
      pairs.check(got == want && (alpha == 0 || value > alpha || (2 * got * alpha + 255) / 510 == value));
    }
  return none_wrong(pairs, "pairs", 65536);
}

}  // namespace spanray::hard
