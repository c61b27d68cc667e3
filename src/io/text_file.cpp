// Public access to what documents are written with, for reports and for signal handlers.
#include <certa/io.h>

#include "io/temporary_file.h"

namespace certa {

void write_text(const std::string& path, std::string_view text) { io::write_files({{path, text}}); }

void remove_temporary_files() noexcept { io::remove_temporaries(); }

}  // namespace certa
