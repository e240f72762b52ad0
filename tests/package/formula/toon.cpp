// toon SCENE: renders a scene whose material names a formula of this project, and looks whether it was used: a light of 1 W/m^2
// on a white surface gives exactly the radiances 0.3, 0.1 and 0, whatever the instruction set.
#include <cstdio>
#include <set>

#include <spanray/render.h>

int main(int argc, char** argv) {
  const auto loaded = spanray::load_scene(argc > 1 ? argv[1] : "");
  if (!loaded) return std::fprintf(stderr, "%s\n", loaded.error().to_string().c_str()), 1;
  const spanray::Scene& scene = loaded.value().scene;
  spanray::Settings settings = scene.settings();
  settings.width = 96, settings.height = 64;
  uint64_t first_hash = 0;
  int rendered = 0;
  for (const spanray::Isa isa : {spanray::Isa::kScalar, spanray::Isa::kSse4, spanray::Isa::kAvx2, spanray::Isa::kAvx512}) {
    settings.isa = isa;
    spanray::Renderer renderer;
    spanray::Framebuffer picture;
    spanray::FrameRequest request;
    request.radiance = true;
    if (!renderer.render(scene, scene.cameras()[0], settings, picture, request)) continue;  // this processor lacks it
    const std::set<float> tones(picture.radiance.begin(), picture.radiance.end());
    if (tones != std::set<float>{0.0f, 0.1f, 0.3f}) {
      std::printf("%zu tones instead of three:", tones.size());
      for (const float tone : tones) std::printf(" %g", static_cast<double>(tone));
      return std::printf("\n"), 1;
    }
    const uint64_t hash = hash_image(picture.color);
    if (rendered++ > 0 && hash != first_hash) return std::printf("instruction sets give different pictures\n"), 1;
    first_hash = hash;
  }
  if (rendered == 0) return std::printf("nothing was rendered\n"), 1;
  std::printf("three tones on %d instruction sets, %016llx\n", rendered, static_cast<unsigned long long>(first_hash));
  return 0;
}
