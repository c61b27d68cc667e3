// From marching tetrahedra to a mesh of a wanted error: vertices onto the zero set; slivers out; edges of triangles
// that are too far off split; then edges merged, the least curved first, while the error allows it; edges flipped and
// vertices moved for better angles; again, while it pays.
//
// Numbers that steer, none of which anything proved depends on: triangles keep an angle of at least 15 degrees unless
// the ones they replace were worse; normals deviate at most 60 degrees from the gradient, likewise.
#include "implicit/simplify.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <set>

#include "core/vector3.h"
#include "implicit/offset.h"
#include "implicit/reshape.h"

namespace certa::implicit {
namespace {

constexpr double good_angle = 0.27, good_alignment = 0.5;
constexpr double no_error = HUGE_VAL;

class Simplifier {
public:
    Simplifier(const Surface& surface, const Frontier* frontier, const expression::Tape& tape,
               const Simplification& wanted, const RunControl& control)
        : field_(tape), mesh_(surface, frontier, field_), wanted_(wanted), control_(control) {}

    std::optional<Surface> run() {
        merge_slivers();
        merge_all();
        if (!refine()) return std::nullopt;
        std::size_t last = 0;
        for (int round = 0; round < 6 && !control_.cancelled(); ++round) {
            control_.report("simplify", 0.3 + 0.1 * round);
            merge_all();
            for (int pass = 0; pass < 2; ++pass) {
                flip_all();
                move_all();
            }
            const std::size_t now = mesh_.living_triangles();
            if (round > 0 && static_cast<double>(now) > 0.99 * static_cast<double>(last)) break;
            last = now;
        }
        mend_angles();
        return mesh_.take();
    }

private:
    /// Not worse than what is replaced, or good enough.
    Fitness tolerable(const Fitness& old) const {
        return {std::max(old.error, wanted_.error), std::min(old.angle, good_angle),
                std::min(old.alignment, good_alignment)};
    }
    Fitness around(std::uint32_t a, std::uint32_t b) {
        Fitness one = mesh_.fitness(mesh_.around(a)), two = mesh_.fitness(mesh_.around(b));
        return {std::max(one.error, two.error), std::min(one.angle, two.angle), std::min(one.alignment, two.alignment)};
    }

    /// Marching tetrahedra makes triangles with nearly no area: their shortest edges go first, so that what remains can
    /// be judged by its shape.
    void merge_slivers() {
        for (int pass = 0; pass < 3; ++pass) {
            mesh_.sort_by_place();
            std::size_t count = 0;
            for (std::uint32_t t = 0; t < mesh_.triangle_count() && !control_.cancelled(); ++t) {
                if (!mesh_.is_alive(t) || mesh_.fitness(mesh_.corners(mesh_.triangle(t))).angle > good_angle) continue;
                const auto [a, b] = shortest_edge(t);
                const Fitness old = around(a, b);
                if (merge(a, b,
                          {std::max(old.error, wanted_.error), std::min(old.angle * 1.0001, good_angle),
                           std::min(old.alignment, good_alignment)}))
                    ++count;
            }
            if (count == 0 || control_.cancelled()) break;
        }
    }
    std::pair<std::uint32_t, std::uint32_t> edge_by(std::uint32_t t, bool shortest) const {
        const Reshaper::Triple& v = mesh_.triangle(t);
        std::pair<std::uint32_t, std::uint32_t> best{v[0], v[1]};
        double length = distance(mesh_.position(v[0]), mesh_.position(v[1]));
        for (std::size_t i = 1; i < 3; ++i) {
            const double d = distance(mesh_.position(v[i]), mesh_.position(v[(i + 1) % 3]));
            if (shortest ? d < length : d > length) {
                length = d;
                best = {v[i], v[(i + 1) % 3]};
            }
        }
        return best;
    }
    std::pair<std::uint32_t, std::uint32_t> shortest_edge(std::uint32_t t) const { return edge_by(t, true); }

    bool merge(std::uint32_t a, std::uint32_t b, const Fitness& limit) {
        const Point3 p = mesh_.position(a), q = mesh_.position(b);
        return mesh_.collapse(a, b, mesh_.project(0.5 * (p + q)), limit) || mesh_.collapse(a, b, p, limit) ||
               mesh_.collapse(a, b, q, limit);
    }

    /// Splits the longest edge of every triangle that is too far off. Where the new vertex cannot go to the zero set it
    /// stays on the edge, and goes there later. False if that takes too many triangles.
    bool refine() {
        for (int round = 0; round < 24; ++round) {
            bool any = false;
            mesh_.sort_by_place();
            const auto count = static_cast<std::uint32_t>(mesh_.triangle_count());
            for (std::uint32_t t = 0; t < count && !control_.cancelled(); ++t) {
                if (!mesh_.is_alive(t)) continue;
                if (mesh_.fitness(mesh_.corners(mesh_.triangle(t))).error <= wanted_.error) continue;
                if (mesh_.living_triangles() >= wanted_.most_triangles) return false;
                any = split_longest(t) || any;
            }
            if (!any || control_.cancelled()) break;
            for (std::uint32_t v = 0; v < mesh_.vertex_count() && !control_.cancelled(); ++v) improve(v, true);
        }
        return true;
    }
    bool split_longest(std::uint32_t t) {
        const auto [a, b] = edge_by(t, false);
        const auto pair = mesh_.at_edge(a, b);
        const Fitness old = mesh_.fitness(pair);
        const Point3 middle = 0.5 * (mesh_.position(a) + mesh_.position(b));
        const Fitness limit{no_error, 0.3 * std::min(old.angle, good_angle), std::min(old.alignment, 0.2)};
        return mesh_.split(a, b, mesh_.project(middle), limit) != no_index ||
               mesh_.split(a, b, middle, {no_error, 1e-4, -1}) != no_index;
    }

    struct Candidate {
        double cost;
        std::uint32_t a, b, stamp_a, stamp_b;
        bool operator<(const Candidate& o) const {  // the cheapest on top
            return cost != o.cost ? cost > o.cost : a != o.a ? a > o.a : b > o.b;
        }
    };
    /// About eight times the distance of the edge from the zero set, and a little for its length.
    double cost_of(std::uint32_t a, std::uint32_t b) const {
        const double length = distance(mesh_.position(a), mesh_.position(b));
        const double bend = distance(mesh_.normal(a), mesh_.normal(b));
        return length * (bend + 1e-3 * length / scale_);
    }
    void offer(std::uint32_t a, std::uint32_t b) {
        if (a > b) std::swap(a, b);
        queue_.push({cost_of(a, b), a, b, stamp_[a], stamp_[b]});
    }

    void merge_all() {
        stamp_.assign(mesh_.vertex_count(), 0);
        queue_ = {};
        scale_ = 0;
        std::size_t count = 0;
        for (std::uint32_t t = 0; t < mesh_.triangle_count(); ++t) {
            if (!mesh_.is_alive(t)) continue;
            const Reshaper::Triple& v = mesh_.triangle(t);
            for (std::size_t i = 0; i < 3; ++i) {
                scale_ += distance(mesh_.position(v[i]), mesh_.position(v[(i + 1) % 3]));
                ++count;
            }
        }
        mesh_.sort_by_place();
        scale_ = count == 0 ? 1 : scale_ / static_cast<double>(count);
        for (std::uint32_t t = 0; t < mesh_.triangle_count(); ++t) {
            if (!mesh_.is_alive(t)) continue;
            const Reshaper::Triple& v = mesh_.triangle(t);
            for (std::size_t i = 0; i < 3; ++i) {
                if (v[i] < v[(i + 1) % 3]) offer(v[i], v[(i + 1) % 3]);
            }
        }
        std::size_t sorted = mesh_.living_triangles();
        while (!queue_.empty() && !control_.cancelled()) {
            // Triangles four times as large would look into 64 times as many cells.
            if (4 * mesh_.living_triangles() < sorted) {
                sorted = mesh_.living_triangles();
                mesh_.sort_by_place();
            }
            const Candidate c = queue_.top();
            queue_.pop();
            if (stamp_[c.a] != c.stamp_a || stamp_[c.b] != c.stamp_b) continue;
            // Hopeless: an edge in the surface is at least this far from the zero set already.
            if (c.cost > 16 * wanted_.error) continue;
            if (!merge(c.a, c.b, tolerable(around(c.a, c.b)))) continue;
            ++stamp_[c.a];
            ++stamp_[c.b];
            for (const std::uint32_t w : mesh_.neighbours(c.a)) offer(c.a, w);
        }
    }

    void flip_all() {
        for (std::uint32_t t = 0; t < mesh_.triangle_count() && !control_.cancelled(); ++t) {
            for (std::size_t i = 0; i < 3 && mesh_.is_alive(t); ++i) {
                const Reshaper::Triple v = mesh_.triangle(t);
                const std::uint32_t a = v[i], b = v[(i + 1) % 3];
                if (a > b || !sees_better(a, b)) continue;
                const Fitness old = mesh_.fitness(mesh_.at_edge(a, b));
                mesh_.flip(a, b,
                           {std::max(old.error, wanted_.error), std::min(1.05 * old.angle, 0.5),
                            std::min(old.alignment, good_alignment)});
            }
        }
    }
    /// The angles opposite to the edge sum up to more than two right ones: the other diagonal is the better one.
    bool sees_better(std::uint32_t a, std::uint32_t b) const {
        double sum = 0;
        for (const std::uint32_t t : mesh_.at_edge(a, b)) {
            for (const std::uint32_t v : mesh_.triangle(t)) {
                if (v == a || v == b) continue;
                const Point3 p = mesh_.position(a) - mesh_.position(v), q = mesh_.position(b) - mesh_.position(v);
                sum += std::atan2(norm(cross(p, q)), dot(p, q));
            }
        }
        return sum > 3.1416;
    }

    void move_all() {
        for (std::uint32_t v = 0; v < mesh_.vertex_count() && !control_.cancelled(); ++v) improve(v, false);
    }
    /// Moves a vertex to the middle of its neighbours, on the zero set, where no angle suffers; or only there.
    void improve(std::uint32_t v, bool only_project) {
        const auto star = mesh_.around(v);
        if (star.empty()) return;
        const Point3 here = mesh_.position(v);
        const Fitness old = mesh_.fitness(star);
        if (!only_project && old.angle < 0.8) {
            Point3 sum{};
            const std::vector<std::uint32_t> ring = mesh_.neighbours(v);
            for (const std::uint32_t w : ring) sum = sum + mesh_.position(w);
            const Point3 middle = mesh_.project((1.0 / static_cast<double>(ring.size())) * sum);
            const Fitness limit{std::max(wanted_.error, old.error), 1.02 * old.angle,
                                std::min(old.alignment, good_alignment)};
            if (mesh_.move(v, middle, limit) || mesh_.move(v, mesh_.project(0.5 * (here + middle)), limit)) return;
        }
        const Point3 to = mesh_.project(here);
        if (to == here) return;
        mesh_.move(v, to,
                   {std::max(wanted_.error, old.error), 0.9 * std::min(old.angle, good_angle),
                    std::min(old.alignment, good_alignment)});
    }

    /// What is left of thin triangles: a few rounds of all that may help, error allowing.
    void mend_angles() {
        for (int round = 0; round < 8; ++round) {
            std::size_t thin = 0;
            for (std::uint32_t t = 0; t < mesh_.triangle_count() && !control_.cancelled(); ++t) {
                if (!mesh_.is_alive(t)) continue;
                const Fitness old = mesh_.fitness(mesh_.corners(mesh_.triangle(t)));
                if (old.angle > 0.2) continue;
                ++thin;
                mend(t);
            }
            if (thin == 0 || control_.cancelled()) return;
        }
    }
    void mend(std::uint32_t t) {
        const auto [a, b] = shortest_edge(t);
        Fitness limit = around(a, b);
        limit = {std::max(limit.error, wanted_.error), 1.01 * limit.angle, std::min(limit.alignment, good_alignment)};
        if (merge(a, b, limit)) return;
        const auto [c, d] = edge_by(t, false);
        Fitness old = mesh_.fitness(mesh_.at_edge(c, d));
        old = {std::max(old.error, wanted_.error), 1.01 * old.angle, std::min(old.alignment, good_alignment)};
        if (mesh_.flip(c, d, old)) return;
        const Reshaper::Triple corners = mesh_.triangle(t);
        for (const std::uint32_t v : corners) improve(v, false);
    }

    Field field_;
    Reshaper mesh_;
    const Simplification& wanted_;
    const RunControl& control_;
    std::priority_queue<Candidate> queue_;
    std::vector<std::uint32_t> stamp_;
    double scale_ = 1;
};

}  // namespace

double smallest_error(const Surface& surface, const expression::Tape& tape, std::size_t most_triangles) {
    Field field(tape);
    double sum = 0;
    for (const Triangle& t : surface.mesh.triangles) {
        const auto at = [&](std::size_t i) { return surface.mesh.positions[index_of(t[i])]; };
        const auto& jet = field.slope((1.0 / 3) * (at(0) + at(1) + at(2)));
        const double error = std::fabs(jet.value) / std::hypot(jet.gradient[0], jet.gradient[1], jet.gradient[2]);
        if (std::isfinite(error)) sum += error;
    }
    return sum / static_cast<double>(most_triangles);
}

std::optional<Surface> simplify(const Surface& surface, const Frontier* frontier, const expression::Tape& tape,
                                const Simplification& wanted, const RunControl& control) {
    if (surface.mesh.triangles.empty()) return surface;
    return Simplifier(surface, frontier, tape, wanted, control).run();
}

std::optional<double> simplify_to_distance(Surface& surface, const Frontier& frontier, const expression::Tape& tape,
                                           double length, const RunControl& control) {
    // The nearer the error to the length, the more pieces the proof needs.
    for (const double share : {0.75, 0.5, 0.3}) {
        std::optional<Surface> trial = simplify(surface, &frontier, tape, {share * length}, control);
        if (!trial) break;
        const bool proved = find_far_triangles(trial->mesh, length, tape, control).empty() && !control.cancelled();
        if (proved || share == 0.3) surface = std::move(*trial);
        if (proved) return length;
        if (control.cancelled()) break;
    }
    return std::nullopt;
}

}  // namespace certa::implicit
