// A window that shows pictures with a user interface over them, and hears keys and mouse. Only this and ui.* know SDL2.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "spanray/image.h"

namespace spanray::demo {

// What the user did since the last call of Window::wait.
struct Input {
  bool quit = false;         // the window was closed
  bool resized = false;      // width() or height() changed
  bool exposed = false;      // the window must be drawn again
  bool any = false;          // anything happened at all
  bool clicked = false;      // a button went down outside of the user interface
  bool look = false;         // the mouse turns the view now
  double mouse_dx = 0, mouse_dy = 0;  // pixels, only counted while look is true
  int move_right = 0, move_up = 0, move_forward = 0;  // -1, 0, 1: keys held down
  bool fast = false;                                  // Shift is held down
  // Pixels from the upper left; -1 if it is not over the picture: outside, over the user interface, or hidden.
  int pointer_x = -1, pointer_y = -1;
  int wheel = 0;                                      // notches, away from the user is positive; outside of the user interface
  std::vector<std::string> pressed;  // names of keys that went down, without repeats: "1", "H", "F12", "Escape", ...
};

class Window {
 public:
  // Errors: no display.
  static Result<std::unique_ptr<Window>> open(const std::string& title, int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  int width() const;   // of the drawable area, pixels
  int height() const;
  void resize(int width, int height);
  // What draw() shows from now on. Errors: of the display.
  Result<void> set_picture(const Image& picture);
  // Puts the picture 1:1 into the upper left corner of the window and over it what `ui` says, in calls of Dear ImGui, and all on
  // the screen. Mouse buttons and wheel over windows that `ui` opened, and keys while one of those is being dragged, are theirs:
  // wait() does not tell them.
  void draw(const std::function<void()>& ui = {});
  void set_title(const std::string& title);
  // The view follows the mouse, which is hidden, until this is called again with false; a held button does so too.
  void set_look(bool look);
  // Waits up to wait_ms milliseconds for something to happen, then tells everything that has. 0: does not wait.
  Input wait(int wait_ms);

 private:
  Window();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spanray::demo
