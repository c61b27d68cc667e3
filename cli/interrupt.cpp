// Signal handling. A handler may only touch lock-free atomics and async-signal-safe functions: it sets a flag, or
// unlinks the temporaries of writes in progress (io keeps their names where a handler can read them) and leaves.
#include "interrupt.h"

#include <certa/io.h>
#include <unistd.h>

#include <csignal>

#include "exit_code.h"

namespace certa::cli {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<bool> graceful{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void handle_signal(int) {
    if (graceful.load() && !interrupted.exchange(true)) return;
    remove_temporary_files();
    _exit(static_cast<int>(ExitCode::interrupted));
}

}  // namespace

void install_signal_handlers() {
    for (const int signal : {SIGINT, SIGTERM}) {
        struct sigaction previous {};
        if (sigaction(signal, nullptr, &previous) == 0 && previous.sa_handler == SIG_IGN) continue;
        struct sigaction action {};
        action.sa_handler = handle_signal;
        action.sa_flags = SA_RESTART;
        sigemptyset(&action.sa_mask);
        sigaction(signal, &action, nullptr);
    }
}

const std::atomic<bool>& interrupt_flag() { return interrupted; }

GracefulScope::GracefulScope() { graceful = true; }
GracefulScope::~GracefulScope() { graceful = false; }

}  // namespace certa::cli
