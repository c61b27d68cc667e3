// `view`: pages as texts, and writing them whole or not at all.
#include <certa/io.h>
#include <certa/view.h>

#include "options.h"
#include "parts.h"

namespace certa::python {
namespace {

py::str view(const py::list& models, const std::string& title, const py::dict& given) {
    ViewOptions options;
    set_options(frontend::view_options(), options, given);
    options.title = title;
    std::vector<ViewModel> pages;
    for (const py::handle entry : models) {
        const auto pair = py::reinterpret_borrow<py::tuple>(entry);
        pages.push_back({py::cast<std::string>(pair[0]), document_from(pair[1])});
    }
    return text(
        run({}, [pages = std::move(pages), options](const RunControl&) { return format_view(pages, options); }));
}

void write_page(const std::string& path, const std::string& page) {
    run({.may_leave = false}, [path, page](const RunControl&) {
        write_text(path, page);
        return true;
    });
}

}  // namespace

void add_views(py::module_& module) {
    module.def("view", &view);
    module.def("write_text", &write_page);
}

}  // namespace certa::python
