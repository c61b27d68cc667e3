#pragma once
// The functions of the extension module `_certa`, one file each, and what they share. Everything here takes and
// returns plain Python objects: dictionaries of arrays that certa/_results.py makes objects of.
#include <certa/conforming.h>
#include <certa/error.h>
#include <certa/implicit.h>
#include <certa/mesh.h>
#include <certa/surface_check.h>

#include <memory>

#include "arrays.h"
#include "frontend/result_fields.h"
#include "run.h"

namespace certa::python {

void add_errors(py::module_& module);
void add_documents(py::module_& module);
void add_conform(py::module_& module);
void add_curvature(py::module_& module);
void add_remesh(py::module_& module);
void add_expressions(py::module_& module);
void add_implicit(py::module_& module);
void add_checks(py::module_& module);
void add_views(py::module_& module);

/// A document from an object of class certa.MeshDocument. Errors: InputError, ValueError.
MeshDocument document_from(py::handle object);
/// The dictionary that certa.MeshDocument is made of.
py::dict to_python(MeshDocument&& document);
/// {"vertices": {name: array}, "polygons": ...}
py::dict fields_to_python(std::vector<Field>&& fields);

py::object to_python(const Defect& defect);
py::list to_python(const std::vector<Defect>& defects);
py::list to_python(const std::vector<ElementRef>& elements);
py::list to_python(const std::vector<Violation>& violations);
py::dict to_python(const std::vector<std::pair<std::string, double>>& stage_seconds);
py::dict to_python(const ConformingCheck& check);
py::dict to_python(const SurfaceCheck& check);
py::dict to_python(const ImplicitCheck& check);
py::list to_python(const std::vector<ImplicitObstacle>& obstacles);

/// The plain members of a result under their names.
template <class Record>
py::dict record_of(const Record& record) {
    py::dict out;
    frontend::visit_fields(record, [&](const char* name, const auto& value) {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Point3>)
            out[name] = point(value);
        else
            out[name] = py::cast(value);
    });
    return out;
}
/// The same, with the times of its stages.
template <class Statistics>
py::dict statistics_of(const Statistics& statistics) {
    py::dict out = record_of(statistics);
    out["stage_seconds"] = to_python(statistics.stage_seconds);
    return out;
}

template <class T>
py::object to_python(const std::optional<T>& value) {
    return value ? py::cast(*value) : py::none();
}

}  // namespace certa::python
