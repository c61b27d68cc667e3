#pragma once
// Files that appear complete or not at all: written under a temporary name in the target's folder, then renamed.
#include <string>
#include <string_view>
#include <vector>

namespace certa::io {

struct FileContent {
    std::string path;
    std::string_view content;
};

/// Writes all files, or none that is visible under its name: every file is complete under a temporary name before the
/// first is renamed. An existing file keeps its permissions; a symbolic link keeps pointing to the file, which is
/// replaced. What is no regular file (a pipe, a device) is written to directly.
///
/// Errors: IoError; temporaries are removed.
void write_files(const std::vector<FileContent>& files);

/// Removes the temporaries of writes in progress. Async-signal-safe: for handlers of SIGINT and SIGTERM that end the
/// process.
void remove_temporaries() noexcept;

}  // namespace certa::io
