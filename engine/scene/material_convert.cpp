#include <algorithm>
#include <cmath>

#include "core/number_text.h"
#include "scene/mtl_library.h"

namespace spanray {
namespace {

constexpr float kMostShininess = 1e4f;
constexpr float kMostRadiance = 1e12f;  // keeps products of colors finite

class Converter {
 public:
  Converter(const MtlMaterial& mtl, const std::string& file, Messages& messages)
      : mtl_(mtl), file_(file), messages_(messages) {}

  Material convert() {
    Material m;
    colors(m);
    m.shininess = scalar(MtlField::kNs, "Ns", m.shininess, 0, kMostShininess);
    m.index_of_refraction = scalar(MtlField::kNi, "Ni", m.index_of_refraction, 1e-3f, 1e3f);
    opacity(m);
    apply_illum(m);
    return m;
  }

 private:
  void warn(int line, const std::string& text) { messages_.warn(file_, line, "material " + quoted(mtl_.name) + ": " + text); }

  float clamped(float value, float least, float most, int line, const char* name) {
    if (value >= least && value <= most) return value;
    const float result = value < least ? least : most;
    warn(line, std::string(name) + " " + number_text(value) + " is out of range; " + number_text(result) + " taken");
    return result;
  }

  bool color(MtlField field, const char* name, float most, float out[3]) {
    const MtlNumbers& n = mtl_[field];
    if (n.line == 0) return false;
    for (int c = 0; c < 3; ++c) out[c] = clamped(n.value[c], 0, most, n.line, name) + 0.0f;
    return true;
  }
  float scalar(MtlField field, const char* name, float absent, float least, float most) {
    const MtlNumbers& n = mtl_[field];
    return n.line == 0 ? absent : clamped(n.value[0], least, most, n.line, name) + 0.0f;
  }

  void colors(Material& m) {
    if (!color(MtlField::kKd, "Kd", 1, m.diffuse) && mtl_[MtlMap::kKd].line > 0)
      for (float& c : m.diffuse) c = 1;
    if (!color(MtlField::kKa, "Ka", kMostRadiance, m.ambient) || (m.ambient[0] == 0 && m.ambient[1] == 0 && m.ambient[2] == 0))
      std::copy(m.diffuse, m.diffuse + 3, m.ambient);
    color(MtlField::kKs, "Ks", kMostRadiance, m.specular);
    color(MtlField::kKe, "Ke", kMostRadiance, m.emission);
    color(MtlField::kTf, "Tf", 1, m.transmission_filter);
  }

  void opacity(Material& m) {
    const MtlNumbers &d = mtl_[MtlField::kD], &tr = mtl_[MtlField::kTr];
    if (d.line > 0)
      m.opacity = scalar(MtlField::kD, "d", 1, 0, 1);
    else if (tr.line > 0)
      m.opacity = 1 - scalar(MtlField::kTr, "Tr", 0, 0, 1);
    if (d.line > 0 && tr.line > 0 && std::fabs(d.value[0] + tr.value[0] - 1) > 1e-3f)
      warn(tr.line, "d " + number_text(d.value[0]) + " and Tr " + number_text(tr.value[0]) + " disagree; d taken");
    MaterialTransparency transparency = m.opacity < 1 ? MaterialTransparency::kAlpha : MaterialTransparency::kOpaque;
    if (mtl_[MtlMap::kD].line > 0) {
      if (m.opacity < 1)
        warn(d.line > 0 ? d.line : tr.line, "has a map_d, so its opacity " + number_text(m.opacity) + " is taken for 1");
      transparency = MaterialTransparency::kMask;
      m.opacity = 1;
    }
    m.transparency = static_cast<int32_t>(transparency);
  }

  void apply_illum(Material& m) {
    const MtlNumbers& n = mtl_[MtlField::kIllum];
    if (n.line == 0) return;
    const float value = n.value[0];
    if (!(value >= 0 && value <= 10) || std::floor(static_cast<double>(value)) != static_cast<double>(value))
      return warn(n.line, "illum " + number_text(value) + " is unknown; 2 taken");
    m.illum = static_cast<int32_t>(value);
    if (m.illum == 0)
      for (int c = 0; c < 3; ++c) m.emission[c] += m.diffuse[c], m.ambient[c] = m.diffuse[c] = m.specular[c] = 0;
    if (m.illum == 1) std::fill(m.specular, m.specular + 3, 0.0f);
    if (m.illum == 3 || m.illum == 5 || m.illum == 8) std::copy(m.specular, m.specular + 3, m.mirror);
    for (float& c : m.mirror) c = std::min(c, 1.0f);  // throughput never grows along a mirror path (HARD-CASES Y12)
    const bool glass = m.illum == 4 || m.illum == 6 || m.illum == 7 || m.illum == 9;
    if (glass && m.opacity == 1 && mtl_[MtlMap::kD].line == 0)
      warn(n.line, "illum " + number_text(value) + " is glass, but no d below 1 and no map_d let light through; opaque");
    if (m.illum == 10) warn(n.line, "illum 10 (shadow catcher) is not supported; 2 taken"), m.illum = 2;
  }

  const MtlMaterial& mtl_;
  const std::string& file_;
  Messages& messages_;
};

}  // namespace

Material convert_material(const MtlMaterial& mtl, const std::string& file, Messages& messages) {
  return Converter(mtl, file, messages).convert();
}

}  // namespace spanray
