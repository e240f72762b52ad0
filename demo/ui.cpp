#include "ui.h"

#include <imgui.h>
#include <imgui_internal.h>

#include <cfloat>

namespace spanray::demo {
namespace {

// Square and dark: the picture is what counts. No anti-aliased edges, which the software renderer of SDL draws badly; all edges
// are horizontal or vertical.
void set_style() {
  ImGuiStyle& s = ImGui::GetStyle();
  ImGui::StyleColorsDark(&s);
  s.AntiAliasedFill = s.AntiAliasedLines = s.AntiAliasedLinesUseTex = false;
  s.WindowRounding = s.FrameRounding = s.GrabRounding = s.ScrollbarRounding = s.PopupRounding = s.TabRounding = 0;
  s.WindowBorderSize = 1;
  s.WindowPadding = {12, 10};
  s.FramePadding = {7, 3};
  s.ItemSpacing = {6, 5};
  s.ScrollbarSize = 12;
  const auto set = [&](int index, int r, int g, int b, float alpha) {
    s.Colors[index] = ImVec4(static_cast<float>(r) / 255, static_cast<float>(g) / 255, static_cast<float>(b) / 255, alpha);
  };
  set(ImGuiCol_WindowBg, 20, 22, 26, 0.92f);
  set(ImGuiCol_Border, 70, 74, 82, 1);
  set(ImGuiCol_Text, 226, 226, 222, 1);
  set(ImGuiCol_TextDisabled, 138, 142, 148, 1);
  set(ImGuiCol_FrameBg, 44, 48, 55, 1);
  set(ImGuiCol_FrameBgHovered, 58, 63, 72, 1);
  set(ImGuiCol_FrameBgActive, 66, 72, 82, 1);
  set(ImGuiCol_Button, 44, 48, 55, 1);
  set(ImGuiCol_ButtonHovered, 62, 68, 78, 1);
  set(ImGuiCol_ButtonActive, 80, 88, 100, 1);
  set(ImGuiCol_Header, 44, 48, 55, 1);
  set(ImGuiCol_HeaderHovered, 58, 63, 72, 1);
  set(ImGuiCol_HeaderActive, 66, 72, 82, 1);
  set(ImGuiCol_CheckMark, 240, 176, 82, 1);
  set(ImGuiCol_SliderGrab, 92, 138, 176, 1);
  set(ImGuiCol_SliderGrabActive, 120, 166, 204, 1);
  set(ImGuiCol_PlotHistogram, 240, 176, 82, 1);
  set(ImGuiCol_PlotLines, 240, 176, 82, 1);
  set(ImGuiCol_Separator, 54, 58, 66, 1);
}

int button_index(Uint8 button) { return button == SDL_BUTTON_LEFT ? 0 : button == SDL_BUTTON_RIGHT ? 1 : button == SDL_BUTTON_MIDDLE ? 2 : -1; }

}  // namespace

Ui::Ui(SDL_Window* window, SDL_Renderer* renderer) : renderer_(renderer) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // leaves no file behind
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.ClipboardUserData = window;
  io.SetClipboardTextFn = [](void*, const char* text) { SDL_SetClipboardText(text); };
  set_style();
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
  font_ = SDL_CreateTexture(renderer, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STATIC, width, height);
  if (font_ != nullptr) {
    SDL_UpdateTexture(font_, nullptr, pixels, 4 * width);
    SDL_SetTextureBlendMode(font_, SDL_BLENDMODE_BLEND);
  }
  io.Fonts->SetTexID(font_);
}

Ui::~Ui() {
  if (font_ != nullptr) SDL_DestroyTexture(font_);
  ImGui::DestroyContext();
}

void Ui::handle(const SDL_Event& event) {
  if (event.type == SDL_MOUSEWHEEL) wheel_ += static_cast<float>(event.wheel.y);
  if (event.type != SDL_MOUSEBUTTONDOWN && event.type != SDL_MOUSEBUTTONUP) return;
  const int index = button_index(event.button.button);
  if (index < 0) return;
  down_[index] = event.type == SDL_MOUSEBUTTONDOWN;
  pressed_[index] |= down_[index];
}

bool Ui::covers(int x, int y) const {
  const ImVec2 point(static_cast<float>(x), static_cast<float>(y));
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
    if (window->Active && !window->Hidden && (window->Flags & ImGuiWindowFlags_NoMouseInputs) == 0 && window->Rect().Contains(point))
      return true;
  return false;
}

bool Ui::holds_input() const { return ImGui::GetCurrentContext()->ActiveId != 0; }

void Ui::clear() {
  for (ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) window->Active = false;
  ImGui::ClearActiveID();
  for (bool& pressed : pressed_) pressed = false;
  wheel_ = 0;
}

void Ui::draw(int width, int height, bool pointer, const std::function<void()>& content) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  const Uint64 now = SDL_GetTicks64();
  io.DeltaTime = now > last_ms_ ? static_cast<float>(now - last_ms_) / 1000 : 0.001f;
  last_ms_ = now;
  int x = 0, y = 0;
  SDL_GetMouseState(&x, &y);
  io.MousePos = pointer ? ImVec2(static_cast<float>(x), static_cast<float>(y)) : ImVec2(-FLT_MAX, -FLT_MAX);
  for (int i = 0; i < 3; ++i) io.MouseDown[i] = pointer && (down_[i] || pressed_[i]), pressed_[i] = false;
  io.MouseWheel = pointer ? wheel_ : 0, wheel_ = 0;
  ImGui::NewFrame();
  content();
  ImGui::Render();
  render(*ImGui::GetDrawData());
}

void Ui::render(const ImDrawData& data) {
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    for (const ImDrawCmd& cmd : list.CmdBuffer) {
      if (cmd.UserCallback != nullptr) continue;
      const ImVec4& c = cmd.ClipRect;
      const SDL_Rect clip = {static_cast<int>(c.x), static_cast<int>(c.y), static_cast<int>(c.z - c.x), static_cast<int>(c.w - c.y)};
      if (clip.w <= 0 || clip.h <= 0) continue;
      SDL_RenderSetClipRect(renderer_, &clip);
      const ImDrawVert* vertex = list.VtxBuffer.Data + cmd.VtxOffset;
      SDL_RenderGeometryRaw(renderer_, static_cast<SDL_Texture*>(cmd.GetTexID()), &vertex->pos.x, sizeof(ImDrawVert),
                            reinterpret_cast<const SDL_Color*>(&vertex->col), sizeof(ImDrawVert), &vertex->uv.x, sizeof(ImDrawVert),
                            list.VtxBuffer.Size - static_cast<int>(cmd.VtxOffset), list.IdxBuffer.Data + cmd.IdxOffset,
                            static_cast<int>(cmd.ElemCount), sizeof(ImDrawIdx));
    }
  }
  SDL_RenderSetClipRect(renderer_, nullptr);
}

}  // namespace spanray::demo
