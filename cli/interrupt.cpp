// Signal handling. A handler may only touch lock-free atomics and async-signal-safe functions: it sets a flag and an
// alarm, or unlinks the temporaries of writes in progress (io keeps their names where a handler can read them) and
// leaves. The alarm ends computations that have not looked at the flag within a second: nothing is being written then.
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

extern "C" void handle_signal(int signal) {
    if (graceful.load() && !interrupted.exchange(true)) {
        alarm(1);
        return;
    }
    remove_temporary_files();
    if (signal == SIGALRM) {
        constexpr char message[] = "\ncerta: interrupted; no output was written\n";
        [[maybe_unused]] const auto written = write(STDERR_FILENO, message, sizeof message - 1);
    }
    _exit(static_cast<int>(ExitCode::interrupted));
}

}  // namespace

void install_signal_handlers() {
    for (const int signal : {SIGINT, SIGTERM, SIGALRM}) {
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

GracefulScope::GracefulScope() {
    graceful = true;
    if (interrupted) alarm(1);  // a stage that begins after the signal has no longer than others
}
GracefulScope::~GracefulScope() {
    graceful = false;
    alarm(0);
}

}  // namespace certa::cli
