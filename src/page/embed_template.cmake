# Writes the template as one raw string literal.
file(READ ${TEMPLATE} text)
if(text MATCHES "\\)certa_page\"")
  message(FATAL_ERROR "${TEMPLATE} would end its string literal")
endif()
file(WRITE ${OUTPUT} "// Made from viewer/template.html.
#include \"page/template.h\"

namespace certa::page {
std::string_view page_template() {
    return R\"certa_page(${text})certa_page\";
}
}  // namespace certa::page
")
