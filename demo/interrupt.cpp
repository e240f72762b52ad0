#include "interrupt.h"

namespace spanray::demo {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM};
volatile std::sig_atomic_t g_asked = 0;

extern "C" void note_signal(int) {
  g_asked = 1;
  for (const int s : kSignals) std::signal(s, SIG_DFL);  // allowed in a handler (POSIX)
}

}  // namespace

Interrupt::Interrupt() {
  g_asked = 0;
  struct sigaction action = {};
  action.sa_handler = note_signal, action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  for (int i = 0; i < 2; ++i) {
    ::sigaction(kSignals[i], &action, &before_[i]);
    if (before_[i].sa_handler == SIG_IGN) ::sigaction(kSignals[i], &before_[i], nullptr);  // what is ignored stays ignored
  }
}

Interrupt::~Interrupt() {
  for (int i = 0; i < 2; ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
}

bool Interrupt::asked() const { return g_asked != 0; }

}  // namespace spanray::demo
