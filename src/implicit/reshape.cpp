// Local changes of a mesh under filters. All four of them are one operation: some triangles go, others with the same
// boundary come (`replace`). Cheap tests come first: angles, error, frontier, then the triangles nearby.
#include "implicit/reshape.h"

#include <algorithm>
#include <cmath>

#include "core/assert.h"
#include "core/vector3.h"

namespace certa::implicit {
namespace {

double smallest_angle(const Corners& t) {
    double smallest = 4;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point3 a = t[(i + 1) % 3] - t[i], b = t[(i + 2) % 3] - t[i];
        smallest = std::min(smallest, std::atan2(norm(cross(a, b)), dot(a, b)));
    }
    return smallest;
}

bool has(const Reshaper::Triple& t, std::uint32_t v) { return t[0] == v || t[1] == v || t[2] == v; }

}  // namespace

Reshaper::Reshaper(const Surface& surface, const Frontier* frontier, Field& field)
    : frontier_(frontier), field_(field), components_(surface.component_of_triangle), grid_(1.0) {
    positions_ = surface.mesh.positions;
    normals_.resize(positions_.size());
    around_.resize(positions_.size());
    for (std::uint32_t v = 0; v < positions_.size(); ++v) set_place(v, positions_[v]);
    for (const Triangle& t : surface.mesh.triangles) {
        const auto id = static_cast<std::uint32_t>(triangles_.size());
        triangles_.push_back({index_of(t[0]), index_of(t[1]), index_of(t[2])});
        for (const std::uint32_t v : triangles_.back()) around_[v].push_back(id);
    }
    alive_.assign(triangles_.size(), 1);
    living_ = triangles_.size();
    sort_by_place();
}

void Reshaper::sort_by_place() {
    double sum = 0;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        if (alive_[t]) sum += distance(positions_[triangles_[t][0]], positions_[triangles_[t][1]]);
    }
    grid_ = TriangleGrid(sum > 0 ? sum / static_cast<double>(living_) : 1.0);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        if (alive_[t]) grid_.insert(t, Bounds::of(corners(triangles_[t])));
    }
}

void Reshaper::set_place(std::uint32_t v, const Point3& place) {
    positions_[v] = place;
    const auto& g = field_.slope(place).gradient;
    const double length = std::hypot(g[0], g[1], g[2]);
    normals_[v] = length > 0 ? Point3{g[0] / length, g[1] / length, g[2] / length} : Point3{};
}

std::vector<std::uint32_t> Reshaper::neighbours(std::uint32_t v) const {
    std::vector<std::uint32_t> result;
    for (const std::uint32_t t : around_[v]) {
        for (const std::uint32_t w : triangles_[t]) {
            if (w != v) result.push_back(w);
        }
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
}

std::array<std::uint32_t, 2> Reshaper::at_edge(std::uint32_t a, std::uint32_t b) const {
    std::array<std::uint32_t, 2> result{no_index, no_index};
    std::size_t count = 0;
    for (const std::uint32_t t : around_[a]) {
        if (has(triangles_[t], b) && count < 2) result[count++] = t;
    }
    return result;
}

Fitness Reshaper::fitness(const Corners& t) {
    Fitness result;
    result.angle = smallest_angle(t);
    const Point3 n = cross(t[1] - t[0], t[2] - t[0]);
    const double area = norm(n);
    static constexpr double samples[7][3] = {
        {0.5, 0.5, 0},     {0, 0.5, 0.5},     {0.5, 0, 0.5},    {1. / 3, 1. / 3, 1. / 3},
        {0.7, 0.15, 0.15}, {0.15, 0.7, 0.15}, {0.15, 0.15, 0.7}};
    for (const auto& w : samples) {
        const Point3 p = w[0] * t[0] + w[1] * t[1] + w[2] * t[2];
        const auto& jet = field_.slope(p);
        const Point3 g{jet.gradient[0], jet.gradient[1], jet.gradient[2]};
        const double slope = norm(g), error = std::fabs(jet.value) / slope;
        if (!std::isfinite(error) || !(area > 0)) return {HUGE_VAL, 0, -1};
        result.error = std::max(result.error, error);
        result.alignment = std::min(result.alignment, dot(n, g) / (area * slope));
    }
    return result;
}

Fitness Reshaper::fitness(std::span<const std::uint32_t> triangles) {
    Fitness result;
    for (const std::uint32_t t : triangles) {
        const Fitness one = fitness(corners(triangles_[t]));
        result = {std::max(result.error, one.error), std::min(result.angle, one.angle),
                  std::min(result.alignment, one.alignment)};
    }
    return result;
}

Point3 Reshaper::project(const Point3& place) {
    Point3 p = place;
    double last = HUGE_VAL;
    for (int round = 0; round < 20; ++round) {
        const auto& jet = field_.slope(p);
        const Point3 g{jet.gradient[0], jet.gradient[1], jet.gradient[2]};
        const double square = dot(g, g), step = std::fabs(jet.value) / std::sqrt(square);
        if (!std::isfinite(step)) return place;
        if (jet.value == 0 || step >= last) break;
        p = p - (jet.value / square) * g;
        last = step;
    }
    return p;
}

bool Reshaper::pair_apart(const Triple& s, const Triple& t) const {
    std::array<std::size_t, 3> in_s{}, in_t{};
    std::size_t shared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            if (s[i] != t[j]) continue;
            in_s[shared] = i;
            in_t[shared++] = j;
        }
    }
    const Corners p = corners(s), q = corners(t);
    if (shared == 0) return triangles_apart(p, q);
    const auto turned = [](const Corners& c, std::size_t i) { return Corners{c[i], c[(i + 1) % 3], c[(i + 2) % 3]}; };
    if (shared == 1) return apart_beyond_corner(turned(p, in_s[0]), turned(q, in_t[0]));
    if (shared == 2)
        return apart_beyond_edge({p[in_s[0]], p[in_s[1]], p[3 - in_s[0] - in_s[1]]},
                                 {q[in_t[0]], q[in_t[1]], q[3 - in_t[0] - in_t[1]]});
    return false;
}

bool Reshaper::keeps_apart(const Triple& t, std::span<const Triple> fresh, std::size_t position) {
    const Corners here = corners(t);
    if (frontier_ != nullptr && !frontier_->is_clear(here)) return false;
    for (std::size_t i = 0; i < position; ++i) {
        if (!pair_apart(t, fresh[i])) return false;
    }
    near_.clear();
    grid_.find(Bounds::of(here), near_);
    const Bounds box = Bounds::of(here);
    for (const std::uint32_t other : near_) {
        if (!box.meets(Bounds::of(corners(triangles_[other])))) continue;
        if (!pair_apart(t, triangles_[other])) return false;
    }
    return true;
}

bool Reshaper::replace(std::span<const std::uint32_t> old, std::span<const Triple> fresh, const Fitness& wanted) {
    for (const Triple& t : fresh) {
        if (smallest_angle(corners(t)) < wanted.angle) return false;
    }
    for (const Triple& t : fresh) {
        const Fitness one = fitness(corners(t));
        if (!(one.error <= wanted.error) || !(one.alignment >= wanted.alignment)) return false;
    }
    for (std::size_t i = 0; i < fresh.size(); ++i) {
        if (!keeps_apart(fresh[i], fresh, i)) return false;
    }
    // From here on the change is made. Boxes in the grid are those before the move, which `collapse` and `move` keep.
    const std::uint32_t component = components_[old[0]];
    for (const std::uint32_t t : old) {
        alive_[t] = 0;
        for (const std::uint32_t v : triangles_[t]) std::erase(around_[v], t);
    }
    std::size_t reused = 0;
    for (const Triple& t : fresh) {
        std::uint32_t id = 0;
        if (reused < old.size()) {
            id = old[reused++];
            triangles_[id] = t;
        } else {
            id = static_cast<std::uint32_t>(triangles_.size());
            triangles_.push_back(t);
            alive_.push_back(0);
            components_.push_back(component);
        }
        alive_[id] = 1;
        for (const std::uint32_t v : t) around_[v].push_back(id);
        grid_.insert(id, Bounds::of(corners(t)));
    }
    living_ = living_ + fresh.size() - old.size();
    return true;
}

bool Reshaper::move(std::uint32_t v, const Point3& place, const Fitness& wanted) {
    const std::vector<std::uint32_t> old = around_[v];
    std::vector<Triple> fresh;
    for (const std::uint32_t t : old) {
        fresh.push_back(triangles_[t]);
        grid_.remove(t, Bounds::of(corners(triangles_[t])));
    }
    const Point3 from = positions_[v];
    positions_[v] = place;
    if (replace(old, fresh, wanted)) {
        set_place(v, place);
        return true;
    }
    positions_[v] = from;
    for (const std::uint32_t t : old) grid_.insert(t, Bounds::of(corners(triangles_[t])));
    return false;
}

bool Reshaper::collapse(std::uint32_t a, std::uint32_t b, const Point3& place, const Fitness& wanted) {
    // The ends must have exactly the two neighbours opposite to the edge in common, else the link is pinched.
    const std::vector<std::uint32_t> of_a = neighbours(a), of_b = neighbours(b);
    std::vector<std::uint32_t> common;
    std::set_intersection(of_a.begin(), of_a.end(), of_b.begin(), of_b.end(), std::back_inserter(common));
    if (common.size() != 2 || of_a.size() + of_b.size() < 8) return false;
    for (const std::uint32_t c : common) {
        if (around_[c].size() <= 3) return false;
    }
    std::vector<std::uint32_t> old = around_[a];
    std::vector<Triple> fresh;
    for (const std::uint32_t t : around_[b]) {
        if (!has(triangles_[t], a)) old.push_back(t);
    }
    for (const std::uint32_t t : old) {
        grid_.remove(t, Bounds::of(corners(triangles_[t])));
        Triple c = triangles_[t];
        if (has(c, a) && has(c, b)) continue;
        for (std::uint32_t& v : c) v = v == b ? a : v;
        fresh.push_back(c);
    }
    const Point3 from = positions_[a];
    positions_[a] = place;
    if (replace(old, fresh, wanted)) {
        set_place(a, place);
        return true;
    }
    positions_[a] = from;
    for (const std::uint32_t t : old) grid_.insert(t, Bounds::of(corners(triangles_[t])));
    return false;
}

bool Reshaper::flip(std::uint32_t a, std::uint32_t b, const Fitness& wanted) {
    const std::array<std::uint32_t, 2> old = at_edge(a, b);
    if (old[1] == no_index) return false;
    const auto opposite = [&](std::uint32_t t) {
        for (const std::uint32_t v : triangles_[t]) {
            if (v != a && v != b) return v;
        }
        return no_index;
    };
    // In the first triangle a is followed by b, or b by a.
    Triple first = triangles_[old[0]];
    while (first[0] != a) std::rotate(first.begin(), first.begin() + 1, first.end());
    const std::uint32_t from = first[1] == b ? a : b, to = first[1] == b ? b : a;
    const std::uint32_t c = opposite(old[0]), d = opposite(old[1]);
    if (around_[a].size() <= 3 || around_[b].size() <= 3) return false;
    for (const std::uint32_t t : around_[c]) {
        if (has(triangles_[t], d)) return false;
    }
    // (from, to, c) and (to, from, d) become (c, from, d) and (d, to, c).
    const std::array<Triple, 2> fresh{Triple{c, from, d}, Triple{d, to, c}};
    for (const std::uint32_t t : old) grid_.remove(t, Bounds::of(corners(triangles_[t])));
    if (replace(old, fresh, wanted)) return true;
    for (const std::uint32_t t : old) grid_.insert(t, Bounds::of(corners(triangles_[t])));
    return false;
}

std::uint32_t Reshaper::split(std::uint32_t a, std::uint32_t b, const Point3& place, const Fitness& wanted) {
    const std::array<std::uint32_t, 2> old = at_edge(a, b);
    CERTA_ASSERT(old[1] != no_index);
    const auto v = static_cast<std::uint32_t>(positions_.size());
    positions_.push_back(place);
    normals_.emplace_back();
    around_.emplace_back();
    std::vector<Triple> fresh;
    for (const std::uint32_t t : old) {
        for (const std::uint32_t end : {a, b}) {
            fresh.push_back(triangles_[t]);
            for (std::uint32_t& w : fresh.back()) w = w == end ? v : w;
        }
        grid_.remove(t, Bounds::of(corners(triangles_[t])));
    }
    if (replace(old, fresh, wanted)) {
        set_place(v, place);
        return v;
    }
    for (const std::uint32_t t : old) grid_.insert(t, Bounds::of(corners(triangles_[t])));
    positions_.pop_back();
    normals_.pop_back();
    around_.pop_back();
    return no_index;
}

Surface Reshaper::take() const {
    Surface result;
    std::vector<std::uint32_t> number(positions_.size(), no_index);
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        if (!alive_[t]) continue;
        Triangle out{};
        for (std::size_t i = 0; i < 3; ++i) {
            std::uint32_t& id = number[triangles_[t][i]];
            if (id == no_index) {
                id = static_cast<std::uint32_t>(result.mesh.positions.size());
                result.mesh.positions.push_back(positions_[triangles_[t][i]]);
            }
            out[i] = VertexId{id};
        }
        result.mesh.triangles.push_back(out);
        result.component_of_triangle.push_back(components_[t]);
    }
    return result;
}

}  // namespace certa::implicit
