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

template <class T>
py::object to_python(const std::optional<T>& value) {
    return value ? py::cast(*value) : py::none();
}

}  // namespace certa::python
