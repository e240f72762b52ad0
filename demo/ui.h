// Dear ImGui over SDL2: hears its events, draws its triangles through SDL_RenderGeometry.
#pragma once
#include <functional>

#include <SDL.h>

struct ImDrawData;

namespace spanray::demo {

class Ui {
 public:
  // Errors of the font's texture leave the user interface without text; nothing else can fail.
  Ui(SDL_Window* window, SDL_Renderer* renderer);
  ~Ui();
  Ui(const Ui&) = delete;
  Ui& operator=(const Ui&) = delete;

  void handle(const SDL_Event& event);
  // Whether a click at this place is meant for a window that was drawn the last time.
  bool covers(int x, int y) const;
  // Whether something in a window is being dragged: mouse and keys are its own then.
  bool holds_input() const;
  // Draws what `content` says (ImGui calls) over what the renderer has. pointer: false hides the mouse from it.
  void draw(int width, int height, bool pointer, const std::function<void()>& content);
  // Nothing was drawn: nothing is covered.
  void clear();

 private:
  void render(const ImDrawData& data);

  SDL_Renderer* renderer_;
  SDL_Texture* font_ = nullptr;
  bool pressed_[3] = {false, false, false};  // since the last draw, even if it is up again
  bool down_[3] = {false, false, false};
  float wheel_ = 0;
  Uint64 last_ms_ = 0;
};

}  // namespace spanray::demo
