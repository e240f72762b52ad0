// make_peer_scenes FOLDER [MODEL.3ds]: synthetic scenes that a rasterizer's parts can be measured with, as OBJ, MTL, PNG and TOML files.
//   overdraw-b2f, overdraw-f2b  32 layers that fill a picture of 16:9, drawn back to front, or front to back
//   grid                        10,000 right triangles with legs of 20 pixels of 1920x1080, at random places, angles and depths
//   grid-bump                   the same with a height map
//   sphere1m                    a sphere of 1000 x 501 quadrilaterals: a million triangles
// One point light without falloff, one color texture. A model is written as asteroid.obj, without materials or light. A tool of the benchmark: its files may differ in the last digit between machines.
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

#include "model_3ds.h"
#include "spanray/image.h"

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kWidth = 1920, kHeight = 1080;
const double kEyeHeight = kHeight / 2 / std::tan(kPi / 8);  // one unit is one pixel at z = 0, with 45 degrees

// An OBJ file being written; indices count from 1.
class ObjFile {
 public:
  explicit ObjFile(const std::filesystem::path& path, const char* material = "surface") : out_(path) {
    out_ << "mtllib peers.mtl\nusemtl " << material << '\n';
  }
  int vertex(double x, double y, double z, double u, double v, double nx = 0, double ny = 0, double nz = 1) {
    char text[256];
    std::snprintf(text, sizeof text, "v %.9g %.9g %.9g\nvt %.9g %.9g\nvn %.9g %.9g %.9g\n", x, y, z, u, v, nx, ny, nz);
    out_ << text;
    return ++vertices_;
  }
  void triangle(int a, int b, int c) {
    char text[128];
    std::snprintf(text, sizeof text, "f %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a, a, b, b, b, c, c, c);
    out_ << text;
  }
  bool good() { return static_cast<bool>(out_.flush()); }

 private:
  std::ofstream out_;
  int vertices_ = 0;
};

bool write_layers(const std::filesystem::path& path, bool back_to_front) {
  ObjFile obj(path);
  for (int i = 0; i < 32; ++i) {
    const double z = -96 + 6.0 * (back_to_front ? i : 31 - i), grow = (kEyeHeight - z) / kEyeHeight;
    const double x = kWidth / 2 * grow, y = kHeight / 2 * grow;
    const auto corner = [&](double cx, double cy) { return obj.vertex(cx, cy, z, cx / 256, cy / 256); };
    const int a = corner(-x, -y), b = corner(x, -y), c = corner(x, y), d = corner(-x, y);
    obj.triangle(a, b, c), obj.triangle(a, c, d);
  }
  return obj.good();
}

bool write_grid(const std::filesystem::path& path, const char* material) {
  ObjFile obj(path, material);
  std::mt19937 bits(1);
  const auto random = [&](double scale) { return (static_cast<double>(static_cast<uint32_t>(bits())) / 4294967296.0 - 0.5) * scale; };
  for (int i = 0; i < 10000; ++i) {
    const double x = random(kWidth), y = random(kHeight), z = random(20), angle = random(2 * kPi);
    const double dx = 20 * std::cos(angle), dy = 20 * std::sin(angle);
    const auto corner = [&](double cx, double cy) { return obj.vertex(cx, cy, z, cx / 256, cy / 256); };
    const int a = corner(x, y), b = corner(x + dx, y + dy), c = corner(x - dy, y + dx);
    obj.triangle(a, b, c);
  }
  return obj.good();
}

bool write_sphere(const std::filesystem::path& path) {
  constexpr int kSegments = 1000, kRings = 501;
  ObjFile obj(path);
  for (int ring = 0; ring <= kRings; ++ring)
    for (int k = 0; k <= kSegments; ++k) {
      const double u = static_cast<double>(k) / kSegments, v = static_cast<double>(ring) / kRings, theta = kPi * (1 - v), phi = 2 * kPi * u;
      const double x = std::sin(theta) * std::sin(phi), y = std::cos(theta), z = std::sin(theta) * std::cos(phi);
      obj.vertex(x, y, z, 8 * u, 4 * v, x, y, z);
    }
  for (int ring = 0; ring < kRings; ++ring)
    for (int k = 0; k < kSegments; ++k) {
      const int a = ring * (kSegments + 1) + k + 1, b = a + 1, c = a + kSegments + 1, d = c + 1;
      if (ring > 0) obj.triangle(a, b, d);
      if (ring < kRings - 1) obj.triangle(a, d, c);
    }
  return obj.good();
}

// Without materials: it is seen in our default light.
bool write_model(const std::filesystem::path& path, const spanray::peers::Model3ds& model) {
  std::ofstream out(path);
  char text[160];
  for (size_t i = 0; i < model.positions.size(); ++i) {
    const auto &p = model.positions[i], &n = model.normals[i];
    std::snprintf(text, sizeof text, "v %.9g %.9g %.9g\nvn %.9g %.9g %.9g\n", double{p[0]}, double{p[1]}, double{p[2]}, double{n[0]}, double{n[1]},
                  double{n[2]});
    out << text;
  }
  for (const auto& f : model.faces) {
    std::snprintf(text, sizeof text, "f %d//%d %d//%d %d//%d\n", f[0] + 1, f[0] + 1, f[1] + 1, f[1] + 1, f[2] + 1, f[2] + 1);
    out << text;
  }
  return static_cast<bool>(out.flush());
}

// Soft blotches between two earthen colors, 512 x 512, repeating.
spanray::Image albedo() {
  constexpr int kSide = 512;
  spanray::Image image{kSide, kSide, {}};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double s = 2 * kPi * x / kSide, t = 2 * kPi * y / kSide;
      const double blend = 0.5 + 0.25 * (std::sin(5 * s + 3 * std::sin(2 * t)) + std::sin(7 * t + 2 * std::sin(3 * s + t)));
      const auto mix = [&](double a, double b) { return static_cast<uint8_t>(a + (b - a) * blend + 0.5); };
      for (const uint8_t channel : {mix(120, 230), mix(80, 205), mix(60, 170), uint8_t{255}}) image.rgba.push_back(channel);
    }
  return image;
}

// Waves of some ten texels' length, 512 x 512, repeating: slopes up to about 1/2 a texel.
spanray::Image heights() {
  constexpr int kSide = 512;
  spanray::Image image{kSide, kSide, {}};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double s = 2 * kPi * x / kSide, t = 2 * kPi * y / kSide;
      const double h = std::sin(37 * s + 2 * std::sin(3 * t)) + std::sin(41 * t + 2 * std::sin(5 * s + 2 * t));
      const auto byte = static_cast<uint8_t>(127.5 + 63.7 * h);
      for (const uint8_t channel : {byte, byte, byte, uint8_t{255}}) image.rgba.push_back(channel);
    }
  return image;
}

bool write_scene(const std::filesystem::path& path, const std::string& obj, double eye_z) {
  std::ofstream out(path);
  out << "obj = \"" << obj << "\"\nbackground = [0.033, 0.033, 0.051]\nambient = [0.1, 0.1, 0.1]\n\n[[camera]]\nname = \"front\"\neye = [0.0, 0.0, "
      << eye_z << "]\ntarget = [0.0, 0.0, 0.0]\nfov_y = 45.0\n\n[[light]]\nkind = \"point\"\nposition = [" << 0.42 * eye_z << ", " << 0.43 * eye_z
      << ", " << 0.8 * eye_z << "]\nintensity = [2.5, 2.5, 2.5]\nattenuation = [1.0, 0.0, 0.0]\n\n[technique]\nculling = \"back\"\n";
  return static_cast<bool>(out.flush());
}

bool write_all(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const char* const material = "Kd 0.8 0.8 0.8\nKs 0.3 0.3 0.3\nNs 32\nillum 2\nmap_Kd albedo.png\n";
  std::ofstream(folder / "peers.mtl") << "newmtl surface\n" << material << "newmtl bumped\n" << material << "map_bump -bm 1 height.png\n";
  const double sphere_eye = 1 / std::sin(kPi / 8);
  return write_png((folder / "albedo.png").string(), albedo()) && write_png((folder / "height.png").string(), heights()) && write_layers(folder / "overdraw-b2f.obj", true) &&
         write_layers(folder / "overdraw-f2b.obj", false) && write_grid(folder / "grid.obj", "surface") &&
         write_grid(folder / "grid-bump.obj", "bumped") && write_sphere(folder / "sphere1m.obj") &&
         write_scene(folder / "grid-bump.toml", "grid-bump.obj", kEyeHeight) &&
         write_scene(folder / "overdraw-b2f.toml", "overdraw-b2f.obj", kEyeHeight) &&
         write_scene(folder / "overdraw-f2b.toml", "overdraw-f2b.obj", kEyeHeight) && write_scene(folder / "grid.toml", "grid.obj", kEyeHeight) &&
         write_scene(folder / "sphere1m.toml", "sphere1m.obj", sphere_eye);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 3) {
    std::fprintf(stderr, "usage: make_peer_scenes FOLDER [MODEL.3ds]\n");
    return 2;
  }
  const std::filesystem::path folder = argv[1];
  bool written = write_all(folder);
  if (written && argc == 3) {
    const auto model = spanray::peers::read_3ds(argv[2]);
    if (!model) {
      std::fprintf(stderr, "make_peer_scenes: %s\n", model.error().to_string().c_str());
      return 1;
    }
    written = write_model(folder / "asteroid.obj", model.value());
  }
  if (written) return 0;
  std::fprintf(stderr, "make_peer_scenes: could not write to %s\n", argv[1]);
  return 1;
}
