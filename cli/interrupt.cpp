// Signal handling. A handler may only touch lock-free atomics and async-signal-safe functions: it sets a flag and an
// alarm, or unlinks the temporaries of writes in progress (io keeps their names where a handler can read them) and
// leaves. The alarm ends computations that do not look at the flag soon: nothing is being written then.
#include "interrupt.h"

#include <certa/io.h>
#include <unistd.h>

#include <csignal>
#include <ctime>

#include "exit_code.h"

namespace certa::cli {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<bool> graceful{false};
static_assert(std::atomic<bool>::is_always_lock_free);

timer_t patience;
bool has_patience = false;  // the timer exists

/// Sends SIGALRM after 0.7 seconds, or not any more.
void set_alarm(bool on) {
    if (!has_patience) return;
    itimerspec time{};
    time.it_value.tv_nsec = on ? 700'000'000 : 0;
    timer_settime(patience, 0, &time, nullptr);
}

extern "C" void handle_signal(int signal) {
    if (graceful.load() && !interrupted.exchange(true)) {
        set_alarm(true);
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
    has_patience = timer_create(CLOCK_MONOTONIC, nullptr, &patience) == 0;
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
    if (interrupted) set_alarm(true);  // a stage that begins after the signal has no longer than others
}
GracefulScope::~GracefulScope() {
    graceful = false;
    set_alarm(false);
}

}  // namespace certa::cli
