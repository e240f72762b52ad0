// The words for settings: one table an enum, shared by scene files, the command line and messages.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "spanray/settings.h"

namespace spanray {

template <class E> struct EnumName {
  E value;
  const char* name;
};

// All names of E in order of their values. There are tables for every enum of settings.h.
template <class E> std::span<const EnumName<E>> enum_names();
template <> std::span<const EnumName<Isa>> enum_names<Isa>();
template <> std::span<const EnumName<Shading>> enum_names<Shading>();
template <> std::span<const EnumName<Shadows>> enum_names<Shadows>();
template <> std::span<const EnumName<Reflections>> enum_names<Reflections>();
template <> std::span<const EnumName<Visibility>> enum_names<Visibility>();
template <> std::span<const EnumName<Filter>> enum_names<Filter>();
template <> std::span<const EnumName<Transparency>> enum_names<Transparency>();
template <> std::span<const EnumName<Culling>> enum_names<Culling>();
template <> std::span<const EnumName<Antialiasing>> enum_names<Antialiasing>();
template <> std::span<const EnumName<Normals>> enum_names<Normals>();
template <> std::span<const EnumName<Powers>> enum_names<Powers>();
template <> std::span<const EnumName<ShadingRate>> enum_names<ShadingRate>();
template <> std::span<const EnumName<TreeQuality>> enum_names<TreeQuality>();
template <> std::span<const EnumName<LightGridUse>> enum_names<LightGridUse>();
template <> std::span<const EnumName<ShadowTerminator>> enum_names<ShadowTerminator>();

// The value named by text, exactly as written in the table.
template <class E> std::optional<E> enum_from_text(std::string_view text) {
  for (const EnumName<E>& entry : enum_names<E>())
    if (text == entry.name) return entry.value;
  return std::nullopt;
}

// "?" for a value without a name.
template <class E> const char* enum_text(E value) {
  for (const EnumName<E>& entry : enum_names<E>())
    if (entry.value == value) return entry.name;
  return "?";
}

template <class E> std::vector<std::string> enum_words() {
  std::vector<std::string> words;
  for (const EnumName<E>& entry : enum_names<E>()) words.emplace_back(entry.name);
  return words;
}

// "flat|gouraud|phong"
template <class E> std::string enum_choices() {
  std::string text;
  for (const EnumName<E>& entry : enum_names<E>()) text += (text.empty() ? "" : "|") + std::string(entry.name);
  return text;
}

// The known word nearest to `word` (few edits away, or else begun by it; case ignored), or "" if none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);
// " (did you mean 'shading'?)", or "" if nothing is near: for the end of a message about an unknown word.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace spanray
