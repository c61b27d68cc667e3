// The library's exceptions as Python's: the classes are those of certa/_errors.py, the data travels as attributes.
#include <certa/implicit.h>

#include "frontend/option_table.h"
#include "parts.h"

namespace certa::python {
namespace {

py::object error_class(const char* name) { return py::module_::import("certa._errors").attr(name); }

py::object spelled(std::string_view message) { return error_class("spelled")(text(message)); }

template <class... Arguments>
void raise(const char* name, Arguments&&... arguments) {
    const py::object type = error_class(name);
    PyErr_SetObject(type.ptr(), type(std::forward<Arguments>(arguments)...).ptr());
}

void translate(const std::exception_ptr& thrown) {
    try {
        if (thrown) std::rethrow_exception(thrown);
    } catch (const ExpressionError& error) {
        raise("ExpressionError", spelled(error.what()), path_text(error.path()), error.line(), text(error.reason()),
              error.column());
    } catch (const IoError& error) {
        raise("IoError", spelled(error.what()), path_text(error.path()), error.line(), spelled(error.reason()));
    } catch (const InputError& error) {
        raise("InputError", spelled(error.what()), to_python(error.defects()));
    } catch (const frontend::OptionError& error) {
        Defect defect;
        defect.kind = DefectKind::option_out_of_range;
        defect.message = error.what();
        raise("InputError", spelled(error.what()), to_python(std::vector<Defect>{defect}));
    } catch (const InternalError& error) {
        raise("InternalError", text(error.what()));
    }
}

}  // namespace

py::list to_python(const std::vector<ElementRef>& elements) {
    py::list list;
    const py::object type = error_class("ElementRef");
    for (const ElementRef& element : elements) list.append(type(name_of(element.kind), element.index));
    return list;
}

py::object to_python(const Defect& defect) {
    return error_class("Defect")(name_of(defect.kind), to_python(defect.elements), point(defect.place),
                                 spelled(defect.message));
}

py::list to_python(const std::vector<Defect>& defects) {
    py::list list;
    for (const Defect& defect : defects) list.append(to_python(defect));
    return list;
}

py::list to_python(const std::vector<Violation>& violations) {
    py::list list;
    const py::object type = error_class("Violation");
    for (const Violation& violation : violations)
        list.append(
            type(violation.promise, to_python(violation.elements), point(violation.place), text(violation.message)));
    return list;
}

py::dict to_python(const std::vector<std::pair<std::string, double>>& stage_seconds) {
    py::dict dictionary;
    for (const auto& [stage, seconds] : stage_seconds) dictionary[py::str(stage)] = seconds;
    return dictionary;
}

void add_errors(py::module_&) {
    py::register_exception_translator([](std::exception_ptr thrown) { translate(thrown); });
}

}  // namespace certa::python
