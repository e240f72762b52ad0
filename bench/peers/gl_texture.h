// Our textures, level by level, as OpenGL objects.
#pragma once
#include "gl.h"
#include "scene/scene_data.h"

namespace spanray::peers {

// kSrgb8: 8 bits, decoded by the driver before it filters; kRgba16: our own 16-bit linear texels.
enum class TexelFormat { kSrgb8, kRgba16 };

// The color of a use: all levels, wrapped or clamped as the use says, filtered as the settings say.
GLuint make_color_texture(const SceneData& scene, const TextureUse& use, Filter filter, TexelFormat format);
// The channel that the use names, one channel of 16 bits, levels 0 to 2 only: engine/shade/accept_kernel.cpp reads masks so.
GLuint make_mask_texture(const SceneData& scene, const TextureUse& use, Filter filter);
// The same with all levels, of which the shader names the one it reads.
GLuint make_height_texture(const SceneData& scene, const TextureUse& use);

}  // namespace spanray::peers
