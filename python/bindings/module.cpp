// The extension module `_certa` inside the package `certa`: its functions, and the table of options as data.
#include "options.h"
#include "parts.h"

PYBIND11_MODULE(_certa, module) {
    using namespace certa::python;
    namespace frontend = certa::frontend;
    module.doc() = "The library behind the package certa; call that.";
    add_errors(module);
    add_waiting(module);
    add_documents(module);
    add_conform(module);
    add_curvature(module);
    add_remesh(module);
    add_expressions(module);
    add_implicit(module);
    add_checks(module);
    add_views(module);
    module.attr("version") = CERTA_VERSION;
    py::dict tables;
    tables["conform"] = describe_options(frontend::conform_options());
    tables["conforming_check"] = describe_options(frontend::conforming_check_options());
    tables["curvature"] = describe_options(frontend::curvature_options());
    tables["remesh"] = describe_options(frontend::remesh_options());
    tables["implicit"] = describe_options(frontend::implicit_options());
    tables["surface_check"] = describe_options(frontend::surface_check_options());
    tables["output"] = describe_options(frontend::output_options());
    tables["view"] = describe_options(frontend::view_options());
    module.attr("option_tables") = tables;
}
