// Between numpy arrays and vectors. Shapes are settled in certa/_inputs.py, where errors can speak of what the caller
// passed; what is left here is what a loop over numbers decides: that every index is one of a vertex.
#include "arrays.h"

#include <algorithm>

namespace certa::python {
namespace {

py::str decoded(std::string_view bytes, const char* errors) {
    PyObject* object = PyUnicode_DecodeUTF8(bytes.data(), static_cast<py::ssize_t>(bytes.size()), errors);
    if (object == nullptr) throw py::error_already_set();
    return py::reinterpret_steal<py::str>(object);
}

/// All in [1, count], and `count` among them: what files that count from 1 would have.
bool seems_to_count_from_one(const std::int64_t* ids, std::size_t size, std::size_t count) {
    const auto [low, high] = std::minmax_element(ids, ids + size);
    return size > 0 && *low >= 1 && static_cast<std::uint64_t>(*high) == count;
}

/// Refusals beyond this number are counted, not listed.
constexpr std::size_t most_defects = 1000;

}  // namespace

py::str text(std::string_view bytes) { return decoded(bytes, "replace"); }
py::str path_text(std::string_view bytes) { return decoded(bytes, "surrogateescape"); }

py::tuple point(const Point3& p) { return py::make_tuple(p.x, p.y, p.z); }

py::array widen(const std::uint32_t* ids, std::size_t count, py::ssize_t width) {
    const auto entries = static_cast<py::ssize_t>(count);
    std::vector<py::ssize_t> shape{entries};
    if (width > 0) shape = {entries / width, width};
    py::array_t<std::int64_t> array(shape);
    std::int64_t* out = array.mutable_data();
    for (std::size_t i = 0; i < count; ++i) out[i] = ids[i] == no_index ? -1 : std::int64_t{ids[i]};
    return array;
}

std::vector<Point3> points_from(const Doubles& array) {
    std::vector<Point3> points(static_cast<std::size_t>(array.size()) / 3);
    const double* in = array.data();
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = {in[3 * i], in[3 * i + 1], in[3 * i + 2]};
    return points;
}

std::vector<std::uint32_t> vertices_from(const Integers& array, ElementKind kind, std::size_t vertex_count,
                                         const std::vector<std::uint32_t>& offsets, std::size_t width) {
    const auto size = static_cast<std::size_t>(array.size());
    const std::int64_t* in = array.data();
    std::vector<std::uint32_t> ids(size);
    std::vector<Defect> defects;
    std::size_t element = 0;
    for (std::size_t i = 0; i < size; ++i) {
        if (offsets.empty())
            element = i / width;
        else
            while (offsets[element + 1] <= i) ++element;
        if (in[i] >= 0 && static_cast<std::uint64_t>(in[i]) < vertex_count) {
            ids[i] = static_cast<std::uint32_t>(in[i]);
        } else if (defects.size() < most_defects) {
            Defect& defect = defects.emplace_back();
            defect.kind = DefectKind::index_out_of_range;
            defect.elements = {{kind, static_cast<std::uint32_t>(element)}};
            defect.message = std::string(name_of(kind)) + " " + std::to_string(element + 1) + " (row " +
                             std::to_string(element) + " from 0) names vertex " + std::to_string(in[i]) +
                             "; there are " + std::to_string(vertex_count) + ", counted from 0" +
                             (in[i] < 0 ? ", and do not count from the end" : "");
        }
    }
    if (!defects.empty() && seems_to_count_from_one(in, size, vertex_count))
        defects.front().message += "; these indices seem to count from 1: subtract 1 from them";
    if (!defects.empty()) throw InputError(std::move(defects));
    return ids;
}

std::vector<std::uint32_t> offsets_from(const Integers& array, std::size_t size, const char* what) {
    const auto count = static_cast<std::size_t>(array.size());
    const std::int64_t* in = array.data();
    bool fits = count > 0 && in[0] == 0 && size < no_index;
    for (std::size_t i = 0; fits && i + 1 < count; ++i) fits = in[i] <= in[i + 1];
    if (!fits || static_cast<std::uint64_t>(in[count - 1]) != size)
        throw py::value_error(std::string(what) + " must begin with 0, not fall, and end with " + std::to_string(size));
    return {in, in + count};
}

}  // namespace certa::python
