// Functions of x, y, z: the operations of the library's expressions by name, for the class of certa/_expressions.py to
// call. Values are opaque here; what may become one is decided there.
#include <certa/implicit.h>

#include <array>

#include "parts.h"

namespace certa::python {
namespace {

using Unary = Expression (*)(const Expression&);
using Binary = Expression (*)(const Expression&, const Expression&);
using Ternary = Expression (*)(const Expression&, const Expression&, const Expression&);

constexpr std::array<std::pair<std::string_view, Unary>, 11> unary{{{"negative", &operator- },
                                                                     {"sqrt", &certa::sqrt},
                                                                     {"exp", &certa::exp},
                                                                     {"log", &certa::log},
                                                                     {"sin", &certa::sin},
                                                                     {"cos", &certa::cos},
                                                                     {"tan", &certa::tan},
                                                                     {"atan", &certa::atan},
                                                                     {"sinh", &certa::sinh},
                                                                     {"cosh", &certa::cosh},
                                                                     {"tanh", &certa::tanh}}};
constexpr std::array<std::pair<std::string_view, Binary>, 5> binary{
    {{"add", &operator+ },
      {"subtract", &operator- }, {"multiply", &operator* }, {"divide", &operator/ }, {"pow", &pow}}};
constexpr std::array<std::pair<std::string_view, Ternary>, 3> ternary{{{"smooth_union", &smooth_union},
                                                                       {"smooth_intersection", &smooth_intersection},
                                                                       {"smooth_difference", &smooth_difference}}};

template <class Table>
auto operation(const Table& table, std::string_view name) {
    for (const auto& [known, function] : table)
        if (known == name) return function;
    throw InternalError("no operation " + std::string(name));
}

Expression variable(const std::string& name) {
    return name == "x"   ? Expression::x()
           : name == "y" ? Expression::y()
           : name == "z" ? Expression::z()
                         : Expression::pi();
}

/// Values and gradients at the rows of an (n, 3) array.
py::tuple values(const Expression& function, const Doubles& places) {
    std::vector<Point3> points = points_from(places);
    auto [results, gradients] = run({}, [function, points = std::move(points)](const RunControl& control) {
        std::pair<std::vector<double>, std::vector<Point3>> both;
        for (const Point3& p : points) {
            if (control.cancelled()) break;
            const PointValue at = evaluate(function, p);
            both.first.push_back(at.value);
            both.second.push_back(at.gradient);
        }
        return both;
    });
    return py::make_tuple(take<double>(std::move(results)), take_points(std::move(gradients)));
}

}  // namespace

void add_expressions(py::module_& module) {
    const py::class_<Expression> type(module, "Function");
    module.def("constant", [](double value) { return Expression(value); });
    module.def("variable", &variable);
    module.def("apply", [](const std::string& name, const Expression& a) { return operation(unary, name)(a); });
    module.def("apply", [](const std::string& name, const Expression& a, const Expression& b) {
        return operation(binary, name)(a, b);
    });
    module.def("apply", [](const std::string& name, const Expression& a, const Expression& b, const Expression& c) {
        return operation(ternary, name)(a, b, c);
    });
    module.def("parse_expression", [](const std::string& source, const std::string& name) {
        return run({}, [source, name](const RunControl&) { return parse_expression(source, name); });
    });
    module.def("format_expression", &format_expression);
    module.def("values", &values);
}

}  // namespace certa::python
