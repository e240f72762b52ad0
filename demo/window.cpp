#include "window.h"

#include <SDL.h>
#include <cstdlib>
#include <optional>

#include "ui.h"

namespace spanray::demo {

struct Window::Impl {
  bool initialised = false;
  SDL_Window* window = nullptr;
  SDL_Renderer* renderer = nullptr;
  SDL_Texture* texture = nullptr;
  int texture_width = 0, texture_height = 0;
  bool look_toggled = false, look_held = false;
  std::optional<Ui> ui;

  ~Impl() {
    ui.reset();
    if (texture != nullptr) SDL_DestroyTexture(texture);
    if (renderer != nullptr) SDL_DestroyRenderer(renderer);
    if (window != nullptr) SDL_DestroyWindow(window);
    if (initialised) SDL_Quit();
  }
  bool look() const { return look_toggled || look_held; }
  void update_look() { SDL_SetRelativeMouseMode(look() ? SDL_TRUE : SDL_FALSE); }
  void handle(const SDL_Event& event, Input& input);
};

namespace {

constexpr Uint32 kPollMs = 4;

Error display_error(const std::string& what) {
  return Error{what + " (" + SDL_GetError() + "); without a display, use `spanray render`"};
}

// SDL falls back to drivers that show nothing; only who asks for one by name gets it.
bool shows_nothing() {
  const char* driver = SDL_GetCurrentVideoDriver();
  const std::string name = driver == nullptr ? "" : driver;
  return (name.empty() || name == "dummy" || name == "offscreen" || name == "evdev") && std::getenv("SDL_VIDEODRIVER") == nullptr;
}

// Digits by place, too: they need Shift on French keyboards. Other keys by their letter.
std::string key_name(const SDL_Keysym& key) {
  if (key.scancode == SDL_SCANCODE_0) return "0";
  if (key.scancode >= SDL_SCANCODE_1 && key.scancode <= SDL_SCANCODE_9)
    return std::string(1, static_cast<char>('1' + (key.scancode - SDL_SCANCODE_1)));
  return SDL_GetKeyName(key.sym);
}

}  // namespace

Window::Window() : impl_(std::make_unique<Impl>()) {}
Window::~Window() = default;

Result<std::unique_ptr<Window>> Window::open(const std::string& title, int width, int height) {
  std::unique_ptr<Window> result(new Window);
  Impl& w = *result->impl_;
  SDL_SetMainReady();
  // Copies on the CPU: exact on every machine, and no graphics driver is needed.
  SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
  SDL_SetHint(SDL_HINT_RENDER_SCALE_QUALITY, "nearest");
  SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
  if (SDL_Init(SDL_INIT_VIDEO) != 0) return display_error("cannot open a window: there is no display");
  w.initialised = true;
  if (shows_nothing()) return Error{"cannot open a window: there is no display; without one, use `spanray render`"};
  w.window = SDL_CreateWindow(title.c_str(), SDL_WINDOWPOS_UNDEFINED, SDL_WINDOWPOS_UNDEFINED, width, height, SDL_WINDOW_RESIZABLE);
  if (w.window == nullptr) return display_error("cannot open a window");
  w.renderer = SDL_CreateRenderer(w.window, -1, SDL_RENDERER_SOFTWARE);
  if (w.renderer == nullptr) return display_error("cannot draw into the window");
  w.ui.emplace(w.window, w.renderer);
  return result;
}

int Window::width() const {
  int w = 0, h = 0;
  SDL_GetWindowSize(impl_->window, &w, &h);
  return w;
}

int Window::height() const {
  int w = 0, h = 0;
  SDL_GetWindowSize(impl_->window, &w, &h);
  return h;
}

void Window::resize(int width, int height) { SDL_SetWindowSize(impl_->window, width, height); }

Result<void> Window::set_picture(const Image& picture) {
  Impl& w = *impl_;
  if (w.texture == nullptr || w.texture_width != picture.width || w.texture_height != picture.height) {
    if (w.texture != nullptr) SDL_DestroyTexture(w.texture);
    w.texture = SDL_CreateTexture(w.renderer, SDL_PIXELFORMAT_RGBA32, SDL_TEXTUREACCESS_STREAMING, picture.width, picture.height);
    if (w.texture == nullptr) return display_error("cannot draw into the window");
    SDL_SetTextureBlendMode(w.texture, SDL_BLENDMODE_NONE);
    w.texture_width = picture.width, w.texture_height = picture.height;
  }
  if (SDL_UpdateTexture(w.texture, nullptr, picture.rgba.data(), picture.width * 4) != 0)
    return display_error("cannot draw into the window");
  return {};
}

void Window::draw(const std::function<void()>& ui) {
  Impl& w = *impl_;
  SDL_SetRenderDrawColor(w.renderer, 0, 0, 0, 255);
  SDL_RenderClear(w.renderer);
  const SDL_Rect whole = {0, 0, w.texture_width, w.texture_height};
  if (w.texture != nullptr) SDL_RenderCopy(w.renderer, w.texture, nullptr, &whole);
  if (ui)
    w.ui->draw(width(), height(), !w.look(), ui);
  else
    w.ui->clear();
  SDL_RenderPresent(w.renderer);
}

void Window::set_title(const std::string& title) { SDL_SetWindowTitle(impl_->window, title.c_str()); }

void Window::set_look(bool look) {
  impl_->look_toggled = look;
  impl_->update_look();
}

void Window::Impl::handle(const SDL_Event& event, Input& input) {
  input.any = true;
  if (!look()) ui->handle(event);
  switch (event.type) {
    case SDL_QUIT: input.quit = true; break;
    case SDL_WINDOWEVENT:
      if (event.window.event == SDL_WINDOWEVENT_SIZE_CHANGED) input.resized = true;
      if (event.window.event == SDL_WINDOWEVENT_EXPOSED) input.exposed = true;
      break;
    case SDL_KEYDOWN:
      if (event.key.repeat == 0) input.pressed.emplace_back(key_name(event.key.keysym));
      break;
    case SDL_MOUSEBUTTONDOWN:
      if (!look() && ui->covers(event.button.x, event.button.y)) break;
      input.clicked = look_held = true;
      update_look();
      break;
    case SDL_MOUSEBUTTONUP:
      if (!look_held) break;
      look_held = false;
      update_look();
      break;
    case SDL_MOUSEWHEEL: {
      int x = 0, y = 0;
      SDL_GetMouseState(&x, &y);
      if (look() || !ui->covers(x, y)) input.wheel += event.wheel.y;
      break;
    }
    case SDL_MOUSEMOTION:
      if (look()) input.mouse_dx += event.motion.xrel, input.mouse_dy += event.motion.yrel;
      break;
    default: break;
  }
}

Input Window::wait(int wait_ms) {
  Input input;
  SDL_Event event;
  // Not SDL_WaitEventTimeout: on X11 it wakes itself up through a second connection, whose message may reach the server after
  // this window is gone, and the program then ends with BadWindow (SDL 2.26).
  const Uint64 end = SDL_GetTicks64() + static_cast<Uint64>(wait_ms);
  for (;;) {
    while (SDL_PollEvent(&event) != 0) impl_->handle(event, input);
    if (input.any || SDL_GetTicks64() >= end) break;
    SDL_Delay(kPollMs);
  }
  input.look = impl_->look();
  if (!input.look && SDL_GetMouseFocus() == impl_->window) {
    int x = 0, y = 0;
    SDL_GetMouseState(&x, &y);
    if (!impl_->ui->covers(x, y)) input.pointer_x = x, input.pointer_y = y;
  }
  if (impl_->ui->holds_input()) return input;
  const Uint8* held = SDL_GetKeyboardState(nullptr);
  const auto axis = [held](SDL_Scancode plus, SDL_Scancode minus) { return int{held[plus]} - int{held[minus]}; };
  // By place on the keyboard, not by letter: WASD is ZQSD in France.
  input.move_right = axis(SDL_SCANCODE_D, SDL_SCANCODE_A);
  input.move_up = axis(SDL_SCANCODE_E, SDL_SCANCODE_Q);
  input.move_forward = axis(SDL_SCANCODE_W, SDL_SCANCODE_S);
  input.fast = held[SDL_SCANCODE_LSHIFT] != 0 || held[SDL_SCANCODE_RSHIFT] != 0;
  return input;
}

}  // namespace spanray::demo
