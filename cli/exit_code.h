#pragma once
// What the command's exit codes mean (README.md); the numbers are a contract.

namespace certa::cli {

enum class ExitCode : int {
    done = 0,
    violated = 1,  ///< `check` found a broken promise
    usage = 2,
    input = 3,   ///< bad data, or file trouble
    unable = 4,  ///< honest inability: budget, smallest feature, memory
    bug = 70,
    interrupted = 130,
};

}  // namespace certa::cli
