#pragma once
// What every subcommand shares: common flags, messages, progress, timings, the report, and how a run ends.
#include <certa/error.h>
#include <certa/io.h>
#include <certa/run_control.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "exit_code.h"
#include "frontend/option_table.h"
#include "progress_line.h"

namespace certa::cli {

using Json = nlohmann::ordered_json;  // keys stay in the order in which they are set

/// The arguments cannot be carried out as given: exit code `usage`.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// What was asked for cannot be had on this machine or within the limits: exit code `unable`.
class Inability : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct CommonFlags {
    bool quiet = false, verbose = false;
    std::string json;      ///< file for the report, "-" for standard output, empty for none
    unsigned threads = 0;  ///< 0: all
};
void add_common_flags(CLI::App& app, CommonFlags& flags);

/// A file that is named on the command line, with the format that overrides its extension.
struct FileArgument {
    std::string path;
    std::optional<Format> format;
    bool given() const { return !path.empty(); }
};
/// `--input-format` or `--output-format`.
void add_format_option(CLI::App& app, const char* name, FileArgument& file);

class Session {
public:
    Session(std::string command, const CommonFlags& flags);

    Json& report() { return report_; }
    const CommonFlags& flags() const { return flags_; }
    /// Progress line, interrupt flag and thread count.
    RunControl control();

    /// Calls `work` and records its time under "stage_seconds".
    template <class Work>
    auto timed(const char* stage, Work&& work) {
        const Timer timer(*this, stage);
        return work();
    }

    void say(const std::string& line);     ///< human summary, on standard error; not with --quiet
    void detail(const std::string& line);  ///< with --verbose only
    void warn(const std::string& line);    ///< recorded in the report too
    void note_defects(const char* key, const std::vector<Defect>& defects);  ///< warnings, repairs, obstacles

    /// Reads a file, refusing first what cannot fit into memory; notes become warnings.
    MeshDocument read(const FileArgument& file, const char* key);
    void write(const FileArgument& file, const MeshDocument& document, const frontend::OutputOptions& options);
    /// Fails unless `file` names a format and lies in a folder that can be written to: told before hours of work.
    void require_writable(const FileArgument& file) const;
    /// Fails with Inability if `bytes` more are not there.
    void require_memory(std::uint64_t bytes, const std::string& purpose) const;

    /// Runs the subcommand, turns what it throws into messages and exit codes, writes the report.
    ExitCode run(const std::function<ExitCode()>& body);

private:
    class Timer {
    public:
        Timer(Session& session, const char* stage)
            : session_(session), stage_(stage), start_(std::chrono::steady_clock::now()) {}
        Timer(const Timer&) = delete;
        Timer& operator=(const Timer&) = delete;
        ~Timer();

    private:
        Session& session_;
        const char* stage_;
        std::chrono::steady_clock::time_point start_;
    };

    ExitCode run_guarded(const std::function<ExitCode()>& body);
    ExitCode fail(ExitCode code, const char* channel, const std::string& message);
    bool write_report(ExitCode code);

    std::string command_;
    CommonFlags flags_;
    ProgressLine progress_;
    Json report_;
    std::chrono::steady_clock::time_point start_;
};

/// Adds one command-line option per row of a table.
template <class Options>
void add_options(CLI::App& app, std::span<const frontend::Option<Options>> table, Options& options) {
    for (const auto& option : table) {
        const std::string name = "--" + std::string(option.flag), help = frontend::help_of(option);
        if (frontend::is_flag(option)) {
            app.add_flag_callback(
                name, [&option, &options] { frontend::set_option(option, options, ""); }, help);
            continue;
        }
        app.add_option_function<std::string>(
               name, [&option, &options](const std::string& text) { frontend::set_option(option, options, text); },
               help)
            ->type_name(frontend::value_name_of(option));
    }
}

}  // namespace certa::cli
