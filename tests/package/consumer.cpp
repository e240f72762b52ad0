// The smallest use of spanray: load a scene, render it from its first camera, print the hash of the picture.
#include <cstdio>

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
  return picture.color.rgba.size() == 64 * 36 * 4 ? 0 : 1;
}
