// What a pixel may show besides its color: what the frame knows about the nearest opaque surface there.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "spanray/render.h"

namespace spanray::demo {

enum class View { kColor, kDepth, kIds, kNormals, kUv, kMaterials };
struct ViewWord {
  View view;
  const char* name;
};
std::span<const ViewWord> view_words();
const char* view_text(View view);
std::string view_choices();  // "color|depth|..."
std::optional<View> view_from_text(const std::string& word);

// The settings to render a view with: without the stages that it does not show. They change no byte of it.
Settings settings_of_view(View view, Settings settings);
// What a frame must give for a view.
void add_request(View view, FrameRequest& request);

// The picture of a view; background is black. Bytes are taken as they are, not as sRGB:
//   color      the picture itself
//   depth      round(255 D^2 / (D^2 + z^2)): white at the eye, half way at the distance D of the camera's target; z along the
//              view axis
//   ids        a color from the hash of the triangle's index, each channel 64 to 255
//   normals    shading normals, bump maps included: round(127.5 + 127.5 n) for x, y, z
//   uv         red and green: fraction of u and v; blue: 192 in every other unit square, else 64
//   materials  as ids, from the material's index
// The same bytes on every machine. picture: of a frame that was asked for add_request(view).
Image view_picture(View view, const Scene& scene, const Camera& camera, const Framebuffer& picture);

}  // namespace spanray::demo
