// Runs every file of the corpus through its target: corpus/<target>/<file>. A crash or an abort is the failure.
// Each file is also cut short at many places, which needs no fuzzer to be worth a try.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "targets.h"

namespace fs = std::filesystem;

int main(int argument_count, char** arguments) {
    if (argument_count != 2) {
        std::fprintf(stderr, "usage: fuzz_replay CORPUS\n");
        return 2;
    }
    for (const std::string_view name : certa::fuzz::target_names()) {
        int files = 0;
        for (const auto& entry : fs::directory_iterator(fs::path(arguments[1]) / name)) {
            std::ifstream in(entry.path(), std::ios::binary);
            const std::string bytes{std::istreambuf_iterator<char>(in), {}};
            std::printf("%s\n", entry.path().c_str());
            std::fflush(stdout);
            certa::fuzz::run_target(name, bytes);
            const std::size_t step = std::max<std::size_t>(1, bytes.size() / 200);
            for (std::size_t size = 0; size < bytes.size(); size += step)
                certa::fuzz::run_target(name, std::string_view(bytes).substr(0, size));
            ++files;
        }
        if (files == 0) {
            std::fprintf(stderr, "no files for the target %s\n", std::string(name).c_str());
            return 1;
        }
    }
    return 0;
}
