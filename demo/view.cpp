#include "view.h"

#include <cmath>
#include <iterator>

#include "math/vec.h"
#include "scene/scene_data.h"

namespace spanray::demo {
namespace {

constexpr ViewWord kWords[] = {{View::kColor, "color"},     {View::kDepth, "depth"}, {View::kIds, "ids"},
                               {View::kNormals, "normals"}, {View::kUv, "uv"},       {View::kMaterials, "materials"}};

struct Rgb {
  uint8_t r, g, b;
};

// A byte from a value in [0, 255], rounded half up.
uint8_t byte_of(double value) { return static_cast<uint8_t>(value + 0.5); }

// Mixes the bits of a word (Vigna 2015, splitmix64).
Rgb color_of_index(uint64_t index) {
  uint64_t z = (index + 1) * 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  z ^= z >> 31;
  const auto channel = [z](int shift) { return static_cast<uint8_t>(64 + (z >> shift) % 192); };
  return {channel(0), channel(16), channel(32)};
}

double target_distance(const Camera& c) {
  return length3(glm::dvec3(c.target[0] - c.eye[0], c.target[1] - c.eye[1], c.target[2] - c.eye[2]));
}

Rgb color_of_normal(const float* n) {
  uint8_t c[3];
  for (int k = 0; k < 3; ++k) c[k] = byte_of(127.5 + 127.5 * double{n[k] < -1 ? -1 : n[k] > 1 ? 1 : n[k]});
  return {c[0], c[1], c[2]};
}

Rgb color_of_uv(const float* uv) {
  const double u = uv[0], v = uv[1], whole_u = std::floor(u), whole_v = std::floor(v);
  // The parity of the sum without converting huge numbers to integers.
  const double sum = whole_u + whole_v;
  const bool odd = sum - 2 * std::floor(sum / 2) != 0;
  return {byte_of(255 * (u - whole_u)), byte_of(255 * (v - whole_v)), static_cast<uint8_t>(odd ? 192 : 64)};
}

}  // namespace

std::span<const ViewWord> view_words() { return kWords; }

const char* view_text(View view) { return kWords[static_cast<size_t>(view)].name; }

std::string view_choices() {
  std::string choices;
  for (const ViewWord& entry : kWords) choices += (choices.empty() ? "" : "|") + std::string(entry.name);
  return choices;
}

std::optional<View> view_from_text(const std::string& word) {
  for (const ViewWord& entry : kWords)
    if (word == entry.name) return entry.view;
  return std::nullopt;
}

Settings settings_of_view(View view, Settings settings) {
  if (view == View::kColor) return settings;
  settings.shadows = Shadows::kNone, settings.reflections = Reflections::kNone;
  settings.samples = 1;  // of one surface: a mean of two ids or depths names neither
  // Cut-outs keep their maps and filter, translucent surfaces their being skipped: they decide what is seen.
  settings.textures = false;
  if (view == View::kNormals) return settings;
  settings.bump = false, settings.shading = Shading::kFlat;
  return settings;
}

void add_request(View view, FrameRequest& request) {
  request.depth |= view == View::kDepth;
  request.primitive |= view != View::kColor;
  request.normal |= view == View::kNormals;
  request.uv |= view == View::kUv;
}

Image view_picture(View view, const Scene& scene, const Camera& camera, const Framebuffer& picture) {
  if (view == View::kColor) return picture.color;
  Image image;
  image.width = picture.color.width, image.height = picture.color.height;
  image.rgba.resize(picture.color.rgba.size());
  const SceneData& data = scene.data();
  const double distance = target_distance(camera);
  const auto color = [&](size_t i, uint32_t primitive) -> Rgb {
    switch (view) {
      case View::kIds: return color_of_index(primitive);
      case View::kMaterials: return color_of_index(material_of(data, primitive));
      case View::kNormals: return color_of_normal(&picture.normal[3 * i]);
      case View::kUv: return color_of_uv(&picture.uv[2 * i]);
      default: break;
    }
    // z = near / depth, so D^2 / (D^2 + z^2) = (D depth)^2 / ((D depth)^2 + near^2).
    const double scaled = distance * double{picture.depth[i]}, square = scaled * scaled;
    const uint8_t gray = byte_of(255 * (square / (square + camera.near_plane * camera.near_plane)));
    return {gray, gray, gray};
  };
  for (size_t i = 0; i < picture.primitive.size(); ++i) {
    const uint32_t primitive = picture.primitive[i];
    const Rgb c = primitive == kNoPrimitive ? Rgb{0, 0, 0} : color(i, primitive);
    uint8_t* out = &image.rgba[4 * i];
    out[0] = c.r, out[1] = c.g, out[2] = c.b, out[3] = 255;
  }
  return image;
}

}  // namespace spanray::demo
