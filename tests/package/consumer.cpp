// The smallest use of spanray: load a scene, render it from its first camera, print the hash of the picture and what is in its middle.
#include <cstdio>
#include <string>

#include <spanray/query.h>
#include <spanray/render.h>

int main(int argc, char** argv) {
  const auto loaded = spanray::load_scene(argc > 1 ? argv[1] : "");
  if (!loaded) return std::fprintf(stderr, "%s\n", loaded.error().to_string().c_str()), 1;
  const spanray::Scene& scene = loaded.value().scene;

  spanray::Settings settings = scene.settings();
  settings.width = 64, settings.height = 36;
  spanray::Renderer renderer;
  spanray::Framebuffer picture;
  const auto stats = renderer.render(scene, scene.cameras()[0], settings, picture);
  if (!stats) return std::fprintf(stderr, "%s\n", stats.error().to_string().c_str()), 1;

  std::printf("%zu triangles, %016llx\n", scene.triangle_count(), static_cast<unsigned long long>(hash_image(picture.color)));
  const auto middle = spanray::SceneQuery(scene).pixel(scene.cameras()[0], settings, 32, 18);
  if (!middle || !middle.value()) return std::fprintf(stderr, "nothing in the middle of the picture\n"), 1;
  const std::string material(middle.value()->name.material);
  std::printf("in the middle: triangle %u of material %s\n", middle.value()->name.triangle, material.c_str());
  return picture.color.rgba.size() == 64 * 36 * 4 ? 0 : 1;
}
