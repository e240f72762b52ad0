#include "interrupt.h"

namespace spanray::demo {
namespace {

constexpr int kSignals[] = {SIGINT, SIGTERM};
volatile std::sig_atomic_t g_asked = 0;

extern "C" void note_signal(int) { g_asked = 1; }

}  // namespace

Interrupt::Interrupt() {
  g_asked = 0;
  struct sigaction action = {};
  action.sa_handler = note_signal, action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigemptyset(&action.sa_mask);
  for (int i = 0; i < 2; ++i) ::sigaction(kSignals[i], &action, &before_[i]);
}

Interrupt::~Interrupt() {
  for (int i = 0; i < 2; ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
}

bool Interrupt::asked() const { return g_asked != 0; }

}  // namespace spanray::demo
