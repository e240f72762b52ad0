// A window that shows pictures and hears keys and mouse. The only file that knows SDL2.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "spanray/image.h"

namespace spanray::demo {

// What the user did since the last call of Window::wait.
struct Input {
  bool quit = false;         // the window was closed
  bool resized = false;      // width() or height() changed
  bool exposed = false;      // the window must be shown again
  bool look = false;         // the mouse turns the view now
  double mouse_dx = 0, mouse_dy = 0;  // pixels, only counted while look is true
  int move_right = 0, move_up = 0, move_forward = 0;  // -1, 0, 1: keys held down
  bool fast = false;                                  // Shift is held down
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
  // Copies the picture 1:1 to the upper left corner of the window. Errors: of the display.
  Result<void> show(const Image& picture);
  // What show() last gave is put on the screen again.
  void show_again();
  void set_title(const std::string& title);
  // The view follows the mouse, which is hidden, until this is called again with false; a held button does so too.
  void set_look(bool look);
  // Waits up to wait_ms milliseconds for something to happen, then tells everything that has.
  Input wait(int wait_ms);

 private:
  Window();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace spanray::demo
