#pragma once
// SIGINT and SIGTERM: the first asks a running computation to stop, and ends the process within a second if that has
// not happened; the second ends the process at once.
#include <atomic>

namespace certa::cli {

/// Installs the handlers; signals that the parent process ignores stay ignored.
void install_signal_handlers();

/// Set by the first signal.
const std::atomic<bool>& interrupt_flag();

/// While one of these exists a signal only sets the flag: a computation is running that will look at it. At all other
/// times a signal removes temporary files and ends the process with ExitCode::interrupted.
class GracefulScope {
public:
    GracefulScope();
    GracefulScope(const GracefulScope&) = delete;
    GracefulScope& operator=(const GracefulScope&) = delete;
    ~GracefulScope();
};

}  // namespace certa::cli
