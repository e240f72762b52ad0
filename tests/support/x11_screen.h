// A virtual X display of our own, its windows and their pixels.
#pragma once
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <unistd.h>

#include <memory>
#include <string>
#include <vector>

#include "spanray/image.h"
#include "support/program.h"

namespace spanray {

// Errors of the X server (a window that is gone) must not end the test program.
inline int ignore_x_error(Display*, XErrorEvent*) { return 0; }

class XScreen {
 public:
  // Starts Xvfb on a free display. ok() is false if it is not installed or does not start.
  XScreen() {
    server_ = std::make_unique<Process>(
        std::vector<std::string>{"Xvfb", "-displayfd", "1", "-screen", "0", "1280x720x24", "-nolisten", "tcp"}, folder_.path());
    for (int i = 0; i < 500 && server_->out().find('\n') == std::string::npos && !server_->wait(0); ++i) ::usleep(20000);
    const std::string number = server_->out();
    if (number.find('\n') == std::string::npos) return;
    name_ = ":" + number.substr(0, number.find('\n'));
    XSetErrorHandler(ignore_x_error);
    display_ = XOpenDisplay(name_.c_str());
  }
  ~XScreen() {
    if (display_ != nullptr) XCloseDisplay(display_);
    server_->send(SIGTERM);
    server_->wait(5);
  }
  bool ok() const { return display_ != nullptr; }
  const std::string& name() const { return name_; }
  Display* display() const { return display_; }

  // The mapped top-level window whose title begins so, 0 if there is none yet.
  Window find(const std::string& title) const {
    Window root, parent, *children = nullptr, found = 0;
    unsigned count = 0;
    if (XQueryTree(display_, DefaultRootWindow(display_), &root, &parent, &children, &count) == 0) return 0;
    for (unsigned i = 0; i < count; ++i) {
      XWindowAttributes attributes;
      if (XGetWindowAttributes(display_, children[i], &attributes) == 0 || attributes.map_state != IsViewable) continue;
      if (title_of(children[i]).rfind(title, 0) == 0) found = children[i];
    }
    if (children != nullptr) XFree(children);
    return found;
  }
  std::string title_of(Window window) const {
    char* name = nullptr;
    if (XFetchName(display_, window, &name) == 0 || name == nullptr) return "";
    const std::string title = name;
    XFree(name);
    return title;
  }
  // What the window shows; empty if it cannot be read. Alpha is 255.
  Image grab(Window window) const {
    Image image;
    XWindowAttributes attributes;
    XSync(display_, False);
    if (XGetWindowAttributes(display_, window, &attributes) == 0) return image;
    XImage* x = XGetImage(display_, window, 0, 0, static_cast<unsigned>(attributes.width), static_cast<unsigned>(attributes.height), AllPlanes, ZPixmap);
    if (x == nullptr) return image;
    image.width = x->width, image.height = x->height;
    for (int j = 0; j < x->height; ++j)
      for (int i = 0; i < x->width; ++i) {
        const unsigned long p = XGetPixel(x, i, j);
        for (const int shift : {16, 8, 0}) image.rgba.push_back(static_cast<uint8_t>(p >> shift));
        image.rgba.push_back(255);
      }
    XDestroyImage(x);
    return image;
  }
  // Asks the window to close, as a window manager does.
  void close(Window window) const {
    XEvent event = {};
    event.xclient.type = ClientMessage;
    event.xclient.window = window;
    event.xclient.message_type = XInternAtom(display_, "WM_PROTOCOLS", False);
    event.xclient.format = 32;
    event.xclient.data.l[0] = static_cast<long>(XInternAtom(display_, "WM_DELETE_WINDOW", False));
    XSendEvent(display_, window, False, NoEventMask, &event);
    XSync(display_, False);
  }
  void resize(Window window, int width, int height) const {
    XResizeWindow(display_, window, static_cast<unsigned>(width), static_cast<unsigned>(height));
    XSync(display_, False);
  }
  void focus(Window window) const {
    XSetInputFocus(display_, window, RevertToParent, CurrentTime);
    XSync(display_, False);
  }
  // Text of the clipboard; empty if there is none, or its owner does not answer within two seconds.
  std::string clipboard() const {
    const Window window = XCreateSimpleWindow(display_, DefaultRootWindow(display_), 0, 0, 1, 1, 0, 0, 0);
    const Atom text = XInternAtom(display_, "UTF8_STRING", False), property = XInternAtom(display_, "SPANRAY_TEST", False);
    XConvertSelection(display_, XInternAtom(display_, "CLIPBOARD", False), text, property, window, CurrentTime);
    XEvent event = {};
    bool answered = false;
    for (int i = 0; i < 200 && !answered; ++i) {
      XSync(display_, False);
      answered = XCheckTypedWindowEvent(display_, window, SelectionNotify, &event) != 0;
      if (!answered) ::usleep(10000);
    }
    std::string result;
    Atom type = 0;
    int format = 0;
    unsigned long items = 0, left = 0;
    unsigned char* bytes = nullptr;
    if (answered && event.xselection.property != 0 &&
        XGetWindowProperty(display_, window, property, 0, 4096, True, text, &type, &format, &items, &left, &bytes) == 0 && bytes != nullptr)
      result.assign(reinterpret_cast<const char*>(bytes), items);
    if (bytes != nullptr) XFree(bytes);
    XDestroyWindow(display_, window);
    return result;
  }
  // Real input events through the X test extension, e.g. {"key", "Escape"}. False if xdotool failed.
  bool input(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "xdotool");
    Process process(arguments, folder_.path(), {"DISPLAY=" + name_});
    return process.wait(20) && process.code() == 0;
  }

 private:
  TempFolder folder_;
  std::unique_ptr<Process> server_;
  std::string name_;
  Display* display_ = nullptr;
};

}  // namespace spanray
