// What a broken assertion says. The file's folders are left out: the text must not depend on where Certa was built.
#include "core/assert.h"

#include <certa/error.h>

#include <string>

namespace certa::core {

void fail_assertion(const char* condition, const char* file, int line) {
    const std::string path = file;
    std::string text = "broken invariant `";
    text.append(condition).append("` in ").append(path.substr(path.find_last_of('/') + 1));
    text.append(":").append(std::to_string(line));
    text.append("; this is a bug in Certa: please report it with the input and the command");
    throw InternalError(text);
}

}  // namespace certa::core
