// Common behaviour of the subcommands. One place decides how each kind of failure is said and with which exit code the
// process ends; the report is written at the very end, whatever happened, and whole or not at all.
#include "session.h"

#include <tbb/global_control.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <new>
#include <thread>

#include "build_info.h"
#include "interrupt.h"
#include "machine.h"
#include "report.h"

namespace certa::cli {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string folder_of(const std::string& path) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

/// Why no file can be made at `path`, where its folder is not there; empty where it is.
std::string missing_folder(const std::string& path) {
    std::error_code error;
    const std::string folder = folder_of(path);
    if (std::filesystem::exists(folder, error) || error) return {};
    return "there is no folder " + folder + "; make it first";
}

void print_line(const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); }

}  // namespace

void add_common_flags(CLI::App& app, CommonFlags& flags) {
    app.add_option("--json", flags.json, "write the report, as JSON, to FILE (-: standard output)")->type_name("FILE");
    app.add_option_function<std::string>(
           "--threads",
           [&flags](const std::string& text) {
               const std::uint64_t count = frontend::parse_count("--threads", text);
               if (count < 1 || count > 4096)
                   throw frontend::OptionError("--threads: " + text + " is out of range; allowed is [1, 4096]");
               flags.threads = static_cast<unsigned>(count);
           },
           "number of threads (default: all); results do not depend on it")
        ->type_name("N");
    app.add_flag("--quiet", flags.quiet, "print nothing but errors");
    app.add_flag("--verbose", flags.verbose, "print stages, their times, and every warning");
}

void add_format_option(CLI::App& app, const char* name, FileArgument& file) {
    app.add_option_function<std::string>(
           name,
           [name, &file](const std::string& text) {
               file.format = format_named(text);
               if (!file.format) throw frontend::OptionError(std::string(name) + ": '" + text + "' is not a format");
           },
           "instead of the one that the file's extension stands for")
        ->type_name("off|obj|ply|stl|poly|smesh|node|medit|vtu|msh|csv");
}

Session::Session(std::string command, const CommonFlags& flags)
    : command_(std::move(command)), flags_(flags), progress_(!flags.quiet), start_(std::chrono::steady_clock::now()) {
    report_["command"] = command_;
    report_["version"] = version();
    report_["commit"] = commit();
}

RunControl Session::control() {
    RunControl control;
    control.progress = [this](std::string_view stage, double fraction) { progress_.show(stage, fraction); };
    control.cancel = &interrupt_flag();
    control.threads = flags_.threads;
    return control;
}

Session::Timer::~Timer() {
    session_.progress_.clear();
    const double seconds = seconds_since(start_);
    session_.report_["stage_seconds"][stage_] = seconds;
    session_.detail(std::string(stage_) + ": " + text_of_seconds(seconds));
}

void Session::say(const std::string& line) {
    progress_.clear();
    if (!flags_.quiet) print_line(line);
}

void Session::detail(const std::string& line) {
    if (flags_.verbose) say(line);
}

void Session::warn(const std::string& line) {
    report_["warnings"].push_back({{"message", line}});
    say("warning: " + line);
}

void Session::note_defects(const char* key, const std::vector<Defect>& defects) {
    constexpr std::size_t shown = 5;
    for (std::size_t i = 0; i < defects.size(); ++i) {
        report_[key].push_back(to_json(defects[i]));
        const std::string line = std::string(label_of(key)) + ": " + defects[i].message;
        if (i < shown)
            say(line);
        else
            detail(line);
    }
    if (defects.size() > shown && !flags_.verbose)
        say("... and " + std::to_string(defects.size() - shown) + " more (--verbose prints them, --json records them)");
}

void Session::require_memory(std::uint64_t bytes, const std::string& purpose) const {
    const std::uint64_t available = available_memory();
    if (bytes <= available) return;
    throw Inability(purpose + " takes about " + text_of_bytes(bytes) + " of memory and " + text_of_bytes(available) +
                    " are free: use a machine with more, or a smaller model");
}

MeshDocument Session::read(const FileArgument& file, const char* key) {
    std::error_code error;
    const std::uint64_t size = file.path == "-" ? 0 : std::filesystem::file_size(file.path, error);
    // The text and the arrays that it becomes are held together; binary formats and short numbers take more than text.
    if (!error) require_memory(3 * size, "reading " + file.path);
    MeshDocument document = timed(key == std::string_view("input") ? "read" : "read_against",
                                  [&] { return read_document(file.path, ReadOptions{.format = file.format}); });
    Json& entry = report_[key];
    entry["path"] = file.path;
    entry["points"] = document.complex.positions.size();
    entry["segments"] = document.complex.segments.size();
    entry["facets"] = document.complex.facet_count();
    entry["tetrahedra"] = document.tetrahedra.size();
    for (const std::string& note : document.notes) warn(file.path + ": " + note);
    return document;
}

void Session::require_writable(const FileArgument& file) const {
    if (file.path == "-") {
        if (!file.format) throw UsageError("-o -: standard output needs --output-format");
        if (flags_.json == "-") throw UsageError("-o - and --json - cannot both go to standard output");
        return;
    }
    if (!file.format && !format_of(file.path))
        throw UsageError(
            file.path +
            ": the format cannot be told from the name; use .mesh, .vtu, .msh, .off, ... or --output-format");
    if (flags_.json == file.path) throw UsageError(file.path + ": the output and the report cannot be the same file");
    if (std::filesystem::is_directory(file.path)) throw IoError(file.path, 0, "is a folder");
    const std::string folder = folder_of(file.path);
    if (const std::string missing = missing_folder(file.path); !missing.empty()) throw IoError(file.path, 0, missing);
    if (access(folder.c_str(), W_OK | X_OK) != 0) throw IoError(file.path, 0, "cannot write into the folder " + folder);
}

void Session::write(const FileArgument& file, const MeshDocument& document, const frontend::OutputOptions& options) {
    timed("write", [&] {
        write_document(
            file.path, document,
            WriteOptions{.format = file.format, .encoding = options.encoding, .msh_version_2 = options.msh_version_2});
    });
    report_["output"]["path"] = file.path;
    report_["output"]["format"] = name_of(file.format ? *file.format : *format_of(file.path));
    say("wrote " + (file.path == "-" ? std::string("standard output") : file.path));
}

ExitCode Session::fail(ExitCode code, const char* channel, const std::string& message) {
    progress_.clear();
    report_["error"]["channel"] = channel;
    report_["error"]["message"] = message;
    print_line("certa " + command_ + ": " + message);
    return code;
}

ExitCode Session::run_guarded(const std::function<ExitCode()>& body) {
    try {
        return body();
    } catch (const UsageError& error) {
        return fail(ExitCode::usage, "usage", error.what());
    } catch (const frontend::OptionError& error) {
        return fail(ExitCode::usage, "usage", error.what());
    } catch (const InputError& error) {
        const ExitCode code = fail(ExitCode::input, "input", error.what());
        report_["error"]["defects"] = to_json(error.defects());
        return code;
    } catch (const IoError& error) {
        const ExitCode code = fail(ExitCode::input, "io", error.what());
        report_["error"]["path"] = error.path();
        report_["error"]["line"] = error.line();
        return code;
    } catch (const Inability& error) {
        return fail(ExitCode::unable, "inability", error.what());
    } catch (const std::bad_alloc&) {
        return fail(ExitCode::unable, "inability", "out of memory; use a machine with more, or a smaller model");
    } catch (const std::exception& error) {
        return fail(
            ExitCode::bug, "bug",
            std::string(error.what()) + "\nThis is a bug in Certa: please report it with the input and the command.");
    }
}

ExitCode Session::run(const std::function<ExitCode()>& body) {
    std::optional<tbb::global_control> limit;
    if (flags_.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, flags_.threads);
    report_["threads"] = flags_.threads > 0 ? flags_.threads : std::max(1U, std::thread::hardware_concurrency());
    // Before the work, not after it.
    if (const std::string missing = flags_.json == "-" ? "" : missing_folder(flags_.json); !missing.empty())
        return fail(ExitCode::input, "io", "the report: " + flags_.json + ": " + missing);
    ExitCode code = run_guarded(body);
    if (interrupt_flag()) code = fail(ExitCode::interrupted, "interrupted", "interrupted; no output was written");
    if (!write_report(code)) code = ExitCode::input;
    return code;
}

bool Session::write_report(ExitCode code) {
    if (flags_.json.empty() || code == ExitCode::usage) return true;  // usage errors touch no file
    report_["stage_seconds"]["total"] = seconds_since(start_);
    report_["peak_memory_bytes"] = peak_memory();
    report_["exit_code"] = static_cast<int>(code);
    // File names need not be UTF-8; the report is.
    const std::string text = report_.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
    if (flags_.json == "-") {
        if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0) return true;
        print_line("certa " + command_ + ": the report: cannot write to standard output");
        return false;
    }
    try {
        write_text(flags_.json, text);
        return true;
    } catch (const IoError& error) {
        print_line("certa " + command_ + ": the report: " + error.what());
        return false;
    }
}

}  // namespace certa::cli
