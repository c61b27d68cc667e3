#pragma once
// Between numpy arrays and the library's vectors. What goes out owns its memory; indices go out as 64-bit integers in
// which -1 stands for "none", since unsigned ones surprise whoever subtracts them.
#include <certa/error.h>
#include <certa/mesh.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace certa::python {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Integers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

/// A text from the library; bytes that are no UTF-8 (of file names, of files) are replaced, not refused.
py::str text(std::string_view bytes);
/// A path as Python writes it: what os.fsencode takes back.
py::str path_text(std::string_view bytes);

py::tuple point(const Point3& p);

/// An array of the given shape around memory that `owner` keeps.
template <class T>
py::array wrap(std::vector<py::ssize_t> shape, const T* data, py::handle owner) {
    return py::array(py::dtype::of<T>(), std::move(shape), data, owner);
}

/// Takes a vector over without a copy; `width` numbers of type T per entry, 0 for a flat array.
template <class T, class Entry>
py::array take(std::vector<Entry>&& values, py::ssize_t width = 0) {
    auto owned = std::make_unique<std::vector<Entry>>(std::move(values));
    const T* data = reinterpret_cast<const T*>(owned->data());
    const auto rows = static_cast<py::ssize_t>(owned->size());
    const py::capsule owner(owned.release(), [](void* p) { delete static_cast<std::vector<Entry>*>(p); });
    if (width == 0) return wrap<T>({rows}, data, owner);
    return wrap<T>({rows, width}, data, owner);
}

inline py::array take_points(std::vector<Point3>&& points) { return take<double>(std::move(points), 3); }

/// 32-bit ids as 64-bit integers, -1 for none; rows of `width`, 0 for a flat array.
py::array widen(const std::uint32_t* ids, std::size_t count, py::ssize_t width = 0);
template <class Id>
py::array widen_ids(const std::vector<Id>& ids) {
    static_assert(sizeof(Id) == 4);
    return widen(reinterpret_cast<const std::uint32_t*>(ids.data()), ids.size());
}
template <class Id, std::size_t width>
py::array widen_ids(const std::vector<std::array<Id, width>>& rows) {
    static_assert(sizeof(std::array<Id, width>) == 4 * width);
    return widen(reinterpret_cast<const std::uint32_t*>(rows.data()), rows.size() * width, width);
}

std::vector<Point3> points_from(const Doubles& array);

/// Vertex numbers of elements, refused with the element where one is no vertex. Element i owns numbers
/// offsets[i] ... offsets[i + 1] - 1; without offsets, `width` numbers each.
std::vector<std::uint32_t> vertices_from(const Integers& array, ElementKind kind, std::size_t vertex_count,
                                         const std::vector<std::uint32_t>& offsets, std::size_t width);
template <class Element>
std::vector<Element> elements_from(const Integers& array, ElementKind kind, std::size_t vertex_count) {
    const std::size_t width = std::tuple_size_v<Element>;
    const std::vector<std::uint32_t> ids = vertices_from(array, kind, vertex_count, {}, width);
    std::vector<Element> elements(ids.size() / width);
    for (std::size_t i = 0; i < ids.size(); ++i) elements[i / width][i % width] = VertexId{ids[i]};
    return elements;
}

/// Offsets into `size` entries: from 0 to size, not falling. Errors: ValueError naming `what`.
std::vector<std::uint32_t> offsets_from(const Integers& array, std::size_t size, const char* what);

}  // namespace certa::python
