// Complete-or-not-at-all writing, and the registry of temporaries for signal handlers.
// The registry is a fixed array: a slot is claimed, filled with the path, then published with a release store, so that
// a handler that interrupts anywhere sees whole paths only. A file is created after its slot is published; unlinking a
// name that does not exist yet is harmless.
#include "io/temporary_file.h"

#include <certa/error.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <utility>

namespace certa::io {
namespace {

enum class SlotState : int { free, claimed, published };

struct Slot {
    std::atomic<SlotState> state{SlotState::free};
    char path[PATH_MAX];
};
static_assert(std::atomic<SlotState>::is_always_lock_free, "a signal handler reads the registry");

constexpr int slot_count = 64;
Slot slots[slot_count];
std::atomic<unsigned> next_number{0};

[[noreturn]] void fail(const std::string& path, const char* doing, int error) {
    throw IoError(path, 0, std::string(doing) + ": " + std::strerror(error));
}

std::string temporary_name(const std::string& target) {
    const std::size_t slash = target.rfind('/');
    const std::size_t name_at = slash == std::string::npos ? 0 : slash + 1;
    // The target's name may be as long as names get: only its start goes into the temporary's.
    return target.substr(0, name_at) + "." + target.substr(name_at, 100) + "." + std::to_string(::getpid()) + "-" +
           std::to_string(next_number.fetch_add(1)) + ".tmp";
}

/// A registered temporary, open for writing; removed on destruction unless it was renamed.
class TemporaryFile {
public:
    explicit TemporaryFile(std::string target) : target_(std::move(target)), path_(temporary_name(target_)) {
        if (path_.size() >= PATH_MAX) fail(target_, "cannot write", ENAMETOOLONG);
        claim_slot();
        std::memcpy(slot_->path, path_.c_str(), path_.size() + 1);
        slot_->state.store(SlotState::published, std::memory_order_release);
        descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ < 0) {
            const int error = errno;
            slot_->state.store(SlotState::free, std::memory_order_release);
            fail(target_, "cannot create a file in its folder", error);
        }
        struct stat existing {};
        if (::stat(target_.c_str(), &existing) == 0) ::fchmod(descriptor_, existing.st_mode & 07777);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;
    ~TemporaryFile() {
        if (descriptor_ >= 0) ::close(descriptor_);
        if (!renamed_) ::unlink(path_.c_str());
        slot_->state.store(SlotState::free, std::memory_order_release);
    }

    int descriptor() const { return descriptor_; }

    void close() {
        // Some file systems report a full disk only here.
        if (::close(std::exchange(descriptor_, -1)) != 0) fail(target_, "cannot write", errno);
    }
    void rename() {
        if (::rename(path_.c_str(), target_.c_str()) != 0) fail(target_, "cannot replace the file", errno);
        renamed_ = true;
    }

private:
    void claim_slot() {
        for (Slot& slot : slots) {
            SlotState expected = SlotState::free;
            if (slot.state.compare_exchange_strong(expected, SlotState::claimed)) {
                slot_ = &slot;
                return;
            }
        }
        throw IoError(target_, 0, "too many files are being written at once");
    }

    std::string target_, path_;
    Slot* slot_ = nullptr;
    int descriptor_ = -1;
    bool renamed_ = false;
};

void write_all(int descriptor, std::string_view content, const std::string& path) {
    while (!content.empty()) {
        const ssize_t written = ::write(descriptor, content.data(), content.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(path, "cannot write", errno);
        content.remove_prefix(static_cast<std::size_t>(written));
    }
}

void write_directly(const FileContent& file) {
    const int descriptor = ::open(file.path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) fail(file.path, "cannot open", errno);
    try {
        write_all(descriptor, file.content, file.path);
    } catch (...) {
        ::close(descriptor);
        throw;
    }
    if (::close(descriptor) != 0) fail(file.path, "cannot write", errno);
}

/// The file that a name stands for: where a chain of symbolic links ends.
std::string resolve_links(const std::string& path) {
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0 || !S_ISLNK(status.st_mode)) return path;
    char* resolved = ::realpath(path.c_str(), nullptr);
    if (resolved == nullptr) return path;  // a dangling link: the link itself is replaced
    std::string target = resolved;
    std::free(resolved);
    return target;
}

}  // namespace

void write_files(const std::vector<FileContent>& files) {
    std::vector<std::unique_ptr<TemporaryFile>> temporaries;
    std::vector<const FileContent*> direct;
    for (const FileContent& file : files) {
        struct stat status {};
        const bool exists = ::stat(file.path.c_str(), &status) == 0;
        if (exists && S_ISDIR(status.st_mode)) throw IoError(file.path, 0, "is a folder");
        // Renaming would replace a write-protected file all the same.
        if (exists && ::access(file.path.c_str(), W_OK) != 0) fail(file.path, "cannot write", errno);
        if (exists && !S_ISREG(status.st_mode)) {
            direct.push_back(&file);
            continue;
        }
        temporaries.push_back(std::make_unique<TemporaryFile>(resolve_links(file.path)));
        write_all(temporaries.back()->descriptor(), file.content, file.path);
        temporaries.back()->close();
    }
    for (const FileContent* file : direct) write_directly(*file);
    for (const auto& temporary : temporaries) temporary->rename();
}

void remove_temporaries() noexcept {
    const int saved = errno;
    for (Slot& slot : slots)
        if (slot.state.load(std::memory_order_acquire) == SlotState::published) ::unlink(slot.path);
    errno = saved;
}

}  // namespace certa::io
