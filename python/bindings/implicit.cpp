// `implicit`: the job, then the independent checker on mesh and certificate, as the command does.
#include <certa/implicit.h>

#include <cmath>

#include "options.h"
#include "parts.h"

namespace certa::python {
namespace {

std::optional<double> length_from(const char* name, const py::object& value, double diagonal) {
    if (value.is_none()) return std::nullopt;
    const std::string given = option_text(name, value);
    const double length = frontend::parse_length(name, given).resolve(diagonal);
    if (!(length > 0.0))
        throw frontend::OptionError(std::string(name) + ": " + given + " is out of range; allowed is above 0");
    return length;
}

ImplicitEngine engine_from(const std::string& name) {
    for (const ImplicitEngine engine :
         {ImplicitEngine::growth, ImplicitEngine::plantinga_vegter, ImplicitEngine::thesis})
        if (name == name_of(engine)) return engine;
    throw frontend::OptionError("engine: '" + name + "' is not one of growth|plantinga-vegter|thesis");
}

struct ImplicitRun {
    ImplicitResult result;
    std::optional<ImplicitCheck> check;
};

ImplicitRun mesh_and_check(const Expression& function, const std::string& source, const Point3& low, const Point3& high,
                           const ImplicitOptions& options, bool verify, const RunControl& control) {
    ImplicitRun finished;
    finished.result = mesh_implicit(function, low, high, options, control);
    const ImplicitResult& result = finished.result;
    if (!verify || result.verdict == ImplicitVerdict::undecided || result.certificate.empty()) return finished;
    finished.check = check_implicit(result.mesh, source, result.certificate, control);
    if (!finished.check->ok() && !control.cancelled())
        throw InternalError("the result failed its own check: " + finished.check->violations.front());
    return finished;
}

py::list components_to_python(const std::vector<ImplicitComponent>& components) {
    py::list out;
    for (const ImplicitComponent& c : components)
        out.append(py::make_tuple(c.genus, c.inner_sign, c.degree, to_python(c.parent), c.loops));
    return out;
}

py::dict result_to_python(ImplicitResult&& result) {
    py::dict out;
    out["outcome"] = name_of(result.outcome);
    out["verdict"] = name_of(result.verdict);
    out["isotopic"] = result.isotopic;
    out["positions"] = take_points(std::move(result.mesh.positions));
    out["triangles"] = widen_ids(result.mesh.triangles);
    out["triangle_components"] = widen_ids(result.triangle_components);
    out["components"] = components_to_python(result.components);
    out["obstacles"] = to_python(result.obstacles);
    out["obstacle_count"] = result.obstacle_count;
    out["hausdorff"] = to_python(result.hausdorff);
    out["low"] = point(result.low);
    out["high"] = point(result.high);
    out["statistics"] = record_of(result.statistics);
    out["certificate"] = result.certificate;
    return out;
}

py::dict implicit(const Expression& function, const Doubles& box, const py::dict& given, const py::object& error,
                  const py::object& hausdorff, const std::string& engine, const py::object& memory_bytes, bool verify,
                  const py::object& progress, unsigned threads) {
    ImplicitOptions options;
    set_options(frontend::implicit_options(), options, given);
    const double* b = box.data();
    const Point3 low{b[0], b[1], b[2]}, high{b[3], b[4], b[5]};
    const double diagonal = std::hypot(high.x - low.x, high.y - low.y, high.z - low.z);
    options.error = length_from("error", error, diagonal);
    options.hausdorff = length_from("hausdorff", hausdorff, diagonal);
    options.engine = engine_from(engine);
    options.certificate = options.engine != ImplicitEngine::plantinga_vegter;
    if (!memory_bytes.is_none()) options.memory_bytes = py::cast<std::uint64_t>(memory_bytes);
    const std::string source = format_expression(function);
    ImplicitRun finished =
        run({progress, threads}, [function, source, low, high, options, verify](const RunControl& control) {
            return mesh_and_check(function, source, low, high, options, verify, control);
        });
    py::dict out = result_to_python(std::move(finished.result));
    out["function"] = source;
    out["check"] = finished.check ? py::object(to_python(*finished.check)) : py::none();
    return out;
}

}  // namespace

py::list to_python(const std::vector<ImplicitObstacle>& obstacles) {
    py::list out;
    for (const ImplicitObstacle& o : obstacles)
        out.append(py::make_tuple(name_of(o.reason), point(o.low), point(o.high)));
    return out;
}

void add_implicit(py::module_& module) { module.def("implicit", &implicit); }

}  // namespace certa::python
