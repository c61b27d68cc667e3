// What a keyword argument may be: a number, a text, or nothing else. Numbers keep all their digits on the way.
#include "options.h"

namespace certa::python {
namespace {

[[noreturn]] void refuse(std::string_view name, py::handle value, const char* expected) {
    const py::object type = py::type::of(value).attr("__name__");
    throw py::type_error(std::string(name) + ": expected " + expected + ", not " + py::cast<std::string>(type));
}

}  // namespace

std::string option_text(std::string_view name, py::handle value) {
    if (py::isinstance<py::str>(value)) return py::cast<std::string>(value);
    if (PyBool_Check(value.ptr())) refuse(name, value, "a number or a text");
    if (PyIndex_Check(value.ptr())) {
        const auto whole = py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr()));
        if (!whole) throw py::error_already_set();
        return py::cast<std::string>(py::str(whole));
    }
    const bool number = PyFloat_Check(value.ptr()) || PyObject_HasAttrString(value.ptr(), "__float__") == 1;
    if (!number) refuse(name, value, "a number or a text");
    const double real = PyFloat_AsDouble(value.ptr());
    if (PyErr_Occurred() != nullptr) {
        PyErr_Clear();
        refuse(name, value, "a number or a text");
    }
    return frontend::text_of(real);
}

bool option_flag(std::string_view name, py::handle value) {
    if (PyBool_Check(value.ptr())) return value.ptr() == Py_True;
    if (py::cast<std::string>(py::type::of(value).attr("__name__")).starts_with("bool"))  // numpy's
        return PyObject_IsTrue(value.ptr()) == 1;
    refuse(name, value, "True or False");
}

}  // namespace certa::python
