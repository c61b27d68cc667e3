// Segments first, then facets, worst triangle first (docs/lazy-protection.md; thesis, Part I, 1.1.5 and 1.1.6).
// Missing is what counts: an edge or triangle that is a face of the triangulation is never touched, whatever encroaches
// upon it. Only shield edges, and in the thesis's schemes segments outside balls, must have the Gabriel property; a
// point that would encroach upon them gives way and they are split instead.
#include "conforming/recovery.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "conforming/facet_interior.h"
#include "core/assert.h"
#include "core/morton.h"
#include "core/random.h"
#include "core/vector3.h"

namespace certa::conforming {
namespace {

using delaunay::PlanarPoint;

double turn(const PlanarPoint& a, const PlanarPoint& b, const PlanarPoint& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Where the way from p to q crosses ab, as a fraction of the way; above 1 where it does not.
double crossing_of(const PlanarPoint& p, const PlanarPoint& q, const PlanarPoint& a, const PlanarPoint& b) {
    const double side_p = turn(a, b, p), side_q = turn(a, b, q);
    if ((side_p > 0.0) == (side_q > 0.0) || side_p == side_q) return 2.0;
    if ((turn(p, q, a) > 0.0) == (turn(p, q, b) > 0.0)) return 2.0;
    return side_p / (side_p - side_q);
}

/// Few pieces as they come; many in rounds, each about as large as all before it together and along a Morton
/// curve: a first point in a wide gap removes many cells, so first points should be few and far between.
void spread_out(MeshState& mesh) {
    std::deque<std::uint32_t>& ids = mesh.piece_queue;
    if (ids.size() < 20'000) return;
    Point3 low = mesh.complex.points[0], high = low;
    for (const Point3& p : mesh.complex.points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const double size = std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    std::vector<std::pair<std::uint64_t, std::uint32_t>> curve;
    for (const std::uint32_t id : ids) {
        const Point3 p = mesh.triangulation.position(mesh.pieces[id].a) - low;
        curve.emplace_back(core::morton_code(p.x / size, p.y / size, p.z / size), id);
    }
    std::sort(curve.begin(), curve.end());
    core::Random random(ids.size());
    std::vector<std::vector<std::uint32_t>> rounds(1);
    while (std::size_t{1} << rounds.size() < ids.size()) rounds.emplace_back();
    for (const auto& [code, id] : curve) {
        std::size_t round = rounds.size() - 1;
        while (round > 0 && random.coin()) --round;
        rounds[round].push_back(id);
    }
    ids.clear();
    for (const auto& round : rounds) ids.insert(ids.end(), round.begin(), round.end());
}

constexpr const char* pile_up = "points pile up without an end in sight";

}  // namespace

Recovery::Recovery(MeshState& mesh, const ProtectedArea* area, const RecoveryOptions& options,
                   const RunControl& control)
    : mesh_(mesh),
      area_(area),
      options_(options),
      control_(control),
      placement_(mesh, options.split_rule),
      segment_points_(mesh.complex.segments.size(), 0),
      facet_points_(mesh.complex.frames.size(), 0) {
    mesh_.heed_borders = options.gabriel;
}

void Recovery::fail(Outcome outcome, bool stuck, ElementRef element, std::uint32_t vertex, const Point3& place,
                    const char* reason) {
    if (is_over()) return;
    result_.outcome = outcome;
    result_.stuck = stuck;
    result_.obstructions.push_back({element, vertex, place, reason});
}

// Where points pile up: the elements that got most of them, down to half as many.
void Recovery::blame_crowded_owners() {
    const std::uint32_t most =
        std::max(*std::max_element(segment_points_.begin(), segment_points_.end()),
                 facet_points_.empty() ? 0 : *std::max_element(facet_points_.begin(), facet_points_.end()));
    const auto blame = [&](ElementKind kind, const std::vector<std::uint32_t>& counts, auto place_of) {
        for (std::uint32_t i = 0; i < counts.size(); ++i) {
            if (2 * counts[i] >= most) result_.obstructions.push_back({{kind, i}, no_index, place_of(i), pile_up});
        }
    };
    const Complex& c = mesh_.complex;
    blame(ElementKind::segment, segment_points_, [&](std::uint32_t s) { return c.points[c.segments[s][0]]; });
    blame(ElementKind::facet, facet_points_, [&](std::uint32_t f) { return c.frames[f].origin; });
}

bool Recovery::check_limits(const Owner& owner, const Point3& place) {
    const ElementRef element{owner.on_segment ? ElementKind::segment : ElementKind::facet, owner.index};
    if (options_.max_points != 0 && mesh_.triangulation.size() >= options_.max_points) {
        fail(Outcome::over_budget, false, element, no_index, place, "the largest allowed number of points is reached");
        return false;
    }
    const std::uint32_t count = ++(owner.on_segment ? segment_points_[owner.index] : facet_points_[owner.index]);
    const std::size_t sides = owner.on_segment ? 0 : mesh_.complex.facet_sides[owner.index].size();
    const bool crowded = options_.owner_budget != 0 && count > options_.owner_budget + 16 * sides;
    const bool many =
        options_.total_budget != 0 && mesh_.triangulation.size() - initial_points_ > options_.total_budget;
    if (!crowded && !many) return true;
    fail(Outcome::over_budget, true, element, no_index, place, pile_up);
    if (many) blame_crowded_owners();
    return false;
}

void Recovery::watch() {
    if (++watched_ % 256 != 0) return;
    if (control_.cancelled()) result_.outcome = Outcome::cancelled;
    const auto open = static_cast<double>(mesh_.facet_queue.size() + mesh_.piece_queue.size());
    control_.report("recover", 1.0 / (1.0 + open / (1.0 + static_cast<double>(mesh_.complex.frames.size()))));
}

bool Recovery::insert_point(const Point3& place, std::uint32_t near, const Owner& owner, std::uint32_t& vertex) {
    watch();
    if (is_over()) return false;
    if (!check_limits(owner, place)) return false;
    const MeshState::Inserted inserted = mesh_.insert(place, near, owner);
    vertex = inserted.vertex;
    return inserted.outcome == MeshState::Insertion::done;
}

bool Recovery::split(std::uint32_t id, const Point3* reference, std::uint32_t near, std::uint32_t facet) {
    const Piece piece = mesh_.pieces[id];
    bool is_crossing = false;
    Point3 place;
    Owner owner{!piece.shield, piece.owner};
    if (piece.shield) {
        const Ball& ball = area_->balls[piece.ball];
        place =
            split_on_sphere(ball.center, ball.radius, mesh_.triangulation.position(piece.a),
                            mesh_.triangulation.position(piece.b), choose_split(*area_, piece.a, piece.b, piece.ball));
    } else {
        std::optional<Point3> crossing;
        if (facet != no_index && near != no_index) crossing = placement_.crossing_of(piece, facet, near);
        is_crossing = crossing.has_value();
        place = is_crossing ? *crossing : placement_.split_of(piece, reference);
    }
    std::uint32_t vertex = no_index;
    if (!insert_point(place, near == no_index ? piece.a : near, owner, vertex)) {
        fail(Outcome::below_min_feature, true, {piece.shield ? ElementKind::facet : ElementKind::segment, piece.owner},
             vertex, place, "a point would come closer than the smallest feature to another one");
        return false;
    }
    mesh_.cut(id, vertex);
    if (is_crossing) mesh_.set_crossing(piece.owner, vertex);
    return true;
}

void Recovery::split_missing(std::uint32_t id) {
    const Piece piece = mesh_.pieces[id];
    if (piece.shield || piece.rule == PieceRule::gabriel) {
        split(id, nullptr);
        return;
    }
    const Point3 a = mesh_.triangulation.position(piece.a), b = mesh_.triangulation.position(piece.b);
    const Point3 middle = a + 0.5 * (b - a);
    const std::uint32_t nearest = mesh_.triangulation.find_nearest(middle, piece.a);
    if (nearest == piece.a || nearest == piece.b) {
        split(id, nullptr, piece.a);
    } else {
        const Point3 reference = mesh_.triangulation.position(nearest);
        const auto facets = mesh_.complex.segment_facets[piece.owner];
        split(id, &reference, nearest, facets.size() == 1 ? facets.front() : no_index);
    }
}

void Recovery::settle_pieces() {
    while (!is_over() && !mesh_.piece_queue.empty()) {
        const std::uint32_t id = mesh_.pop_piece();
        if (!mesh_.is_satisfied(mesh_.pieces[id])) split_missing(id);
    }
}

bool Recovery::settle_plain_triangle(std::uint32_t facet) {
    if (options_.gabriel || mesh_.find_work(facet) != nullptr) return false;
    const auto corners = triangle_of(mesh_.complex, facet);
    if (!corners) return false;
    for (const Side& side : mesh_.complex.facet_sides[facet]) {
        if (mesh_.is_cut(side.segment)) return false;
    }
    return mesh_.mark(facet, *corners);
}

bool Recovery::settle_facet(std::uint32_t facet) {
    if (settle_plain_triangle(facet)) return true;
    switch (patch_.build(mesh_, facet, options_.gabriel)) {
        case FacetPatch::State::invalid:
            fail(Outcome::below_min_feature, true, {ElementKind::facet, facet}, no_index,
                 mesh_.complex.frames[facet].origin, "the sides of a facet cross up to rounding");
            return true;
        case FacetPatch::State::missing:
            return false;
        case FacetPatch::State::complete:
            break;
    }
    std::vector<std::array<std::uint32_t, 3>>& kept = mesh_.work_of(facet).triangles;
    kept.clear();
    for (std::size_t i = 0; i < patch_.triangles.size(); ++i) {
        const auto& t = patch_.triangles[i];
        kept.push_back({patch_.vertices[t[0]], patch_.vertices[t[1]], patch_.vertices[t[2]]});
        mesh_.triangulation.mark_face(patch_.faces[i], facet);
    }
    return true;
}

Recovery::Blocking Recovery::find_blocking_piece(const std::array<std::uint32_t, 3>& triangle,
                                                 const PlanarPoint& p) const {
    const PlanarPoint &a = patch_.points[triangle[0]], &b = patch_.points[triangle[1]], &c = patch_.points[triangle[2]];
    const PlanarPoint from{(a.x + b.x + c.x) / 3.0, (a.y + b.y + c.y) / 3.0};
    Blocking crossed, entered;
    double first = 1.5, deepest = 1.0 - 1e-9;
    for (std::uint32_t e = 0; e < patch_.edges.size(); ++e) {
        const PlanarPoint &x = patch_.points[patch_.edges[e].a], &y = patch_.points[patch_.edges[e].b];
        const double crossing = crossing_of(from, p, x, y);
        if (crossing < first) {
            first = crossing;
            crossed = {true, e};
        }
        const double depth =
            std::hypot(p.x - 0.5 * (x.x + y.x), p.y - 0.5 * (x.y + y.y)) / (0.5 * std::hypot(x.x - y.x, x.y - y.y));
        if (depth < deepest && (options_.mirroring || mesh_.pieces[patch_.pieces[e]].rule == PieceRule::gabriel)) {
            deepest = depth;
            entered = {true, e};
        }
    }
    return crossed.found ? crossed : entered;
}

bool Recovery::is_unchanged(std::uint32_t edge) const {
    const Piece& piece = mesh_.pieces[patch_.pieces[edge]];
    const std::uint32_t a = patch_.vertices[patch_.edges[edge].a], b = patch_.vertices[patch_.edges[edge].b];
    return piece.a == a && piece.b == b;
}

// Circumcentres of slivers lie anywhere; what counts is the way there, not how far it goes beyond the facet.
PlanarPoint Recovery::keep_near(const PlanarPoint& p) const {
    PlanarPoint low = patch_.points[0], high = low;
    for (const PlanarPoint& q : patch_.points) {
        low = {std::min(low.x, q.x), std::min(low.y, q.y)};
        high = {std::max(high.x, q.x), std::max(high.y, q.y)};
    }
    const PlanarPoint middle{0.5 * (low.x + high.x), 0.5 * (low.y + high.y)};
    const double reach = 2.0 * std::hypot(high.x - low.x, high.y - low.y);
    const double away = std::hypot(p.x - middle.x, p.y - middle.y);
    if (away <= reach) return p;
    return {middle.x + reach / away * (p.x - middle.x), middle.y + reach / away * (p.y - middle.y)};
}

bool Recovery::insert_in_facet(const Point3& place, std::uint32_t near) {
    mesh_.find_encroached(place, near, encroached_);
    if (!encroached_.empty()) {
        const std::vector<std::uint32_t> pieces = encroached_;
        for (const std::uint32_t id : pieces) {
            if (!split(id, nullptr)) return true;
        }
        return true;
    }
    std::uint32_t vertex = no_index;
    if (insert_point(place, near, {false, patch_.facet}, vertex)) {
        mesh_.work_of(patch_.facet).points.push_back(vertex);
        return true;
    }
    if (is_over()) return true;
    std::vector<std::uint32_t> facets;
    mesh_.find_facets(vertex, facets);
    const Point3 offset = mesh_.triangulation.position(vertex) - mesh_.complex.frames[patch_.facet].origin;
    const bool in_plane = std::abs(dot(offset, mesh_.complex.frames[patch_.facet].normal)) <= mesh_.rounding;
    if (in_plane && vertex >= mesh_.complex.points.size() &&
        std::find(facets.begin(), facets.end(), patch_.facet) == facets.end()) {
        mesh_.adopt(patch_.facet, vertex);
        return true;
    }
    return false;
}

bool Recovery::split_shield_of(const std::array<std::uint32_t, 3>& triangle) {
    if (is_center_.empty()) return false;
    const auto is_center = [&](std::uint32_t corner) {
        const std::uint32_t v = patch_.vertices[corner];
        return v < initial_points_ && is_center_[v] != 0;
    };
    if (std::none_of(triangle.begin(), triangle.end(), is_center)) return false;
    for (std::uint32_t e = 0; e < patch_.edges.size(); ++e) {
        if (!mesh_.pieces[patch_.pieces[e]].shield) continue;
        const auto has = [&](std::uint32_t p) {
            return std::find(triangle.begin(), triangle.end(), p) != triangle.end();
        };
        if (has(patch_.edges[e].a) && has(patch_.edges[e].b)) {
            split(patch_.pieces[e], nullptr);
            return true;
        }
    }
    return false;
}

void Recovery::refine_triangle(const FacetPatch::Missing& missing) {
    const auto& triangle = patch_.triangles[missing.triangle];
    if (split_shield_of(triangle)) return;
    const std::uint32_t near = patch_.vertices[triangle[0]];
    PlanarPoint place = missing.center;
    bool mirrored = false;
    std::uint32_t witness = no_index;
    if (!std::isfinite(missing.radius)) {
        // Three points on a line up to rounding: the middle of the longest side stands for the centre.
        double longest = -1.0;
        for (int i = 0; i < 3; ++i) {
            const PlanarPoint &a = patch_.points[triangle[i]], &b = patch_.points[triangle[(i + 1) % 3]];
            const double length = std::hypot(a.x - b.x, a.y - b.y);
            if (length > longest) {
                longest = length;
                place = {0.5 * (a.x + b.x), 0.5 * (a.y + b.y)};
            }
        }
    } else if (options_.mirroring) {
        const Point3 center = patch_.lift(missing.center);
        const std::uint32_t nearest = mesh_.triangulation.find_nearest(center, near);
        witness = nearest;
        if (distance(mesh_.triangulation.position(nearest), center) < missing.radius) {
            if (const auto image = placement_.mirror(patch_.facet, center, missing.radius, nearest)) {
                const PlanarPoint p = patch_.flatten(*image);
                const auto near_corner = [&](std::uint32_t corner) {
                    const PlanarPoint& c = patch_.points[corner];
                    return std::hypot(p.x - c.x, p.y - c.y) < 1e-6 * missing.radius;
                };
                if (std::none_of(triangle.begin(), triangle.end(), near_corner)) {
                    place = p;
                    mirrored = true;
                }
            }
        }
    }
    for (;;) {
        const PlanarPoint aim = keep_near(place);
        const Point3 lifted = patch_.lift(aim);
        const Blocking blocking = find_blocking_piece(triangle, aim);
        if (blocking.found) {
            // A piece that was cut since is in the way no longer: the next look at the facet will tell.
            if (is_unchanged(blocking.edge))
                split(patch_.pieces[blocking.edge], &lifted, mirrored ? witness : no_index, patch_.facet);
            return;
        }
        if (insert_in_facet(lifted, near)) return;
        if (!mirrored) break;
        mirrored = false;
        place = missing.center;
    }
    fail(Outcome::below_min_feature, true, {ElementKind::facet, patch_.facet}, no_index, patch_.lift(keep_near(place)),
         "a point would come closer than the smallest feature to another one");
}

// The worst triangles that do not touch each other's circles, a fraction of the facet at a time: laying it out is dear.
void Recovery::refine() {
    const std::size_t limit = 1 + patch_.triangles.size() / 8;
    std::vector<PlanarPoint> placed;
    std::vector<std::uint32_t> facets;
    std::size_t seen = mesh_.triangulation.size(), done = 0;
    for (const FacetPatch::Missing& missing : patch_.missing) {
        const auto hits = [&](const PlanarPoint& p) {
            return std::hypot(p.x - missing.center.x, p.y - missing.center.y) < missing.radius * (1.0 + 1e-9);
        };
        if (std::any_of(placed.begin(), placed.end(), hits)) continue;
        refine_triangle(missing);
        if (is_over() || ++done >= limit) break;
        settle_pieces();
        for (; seen < mesh_.triangulation.size(); ++seen) {
            const auto v = static_cast<std::uint32_t>(seen);
            mesh_.find_facets(v, facets);
            if (std::find(facets.begin(), facets.end(), patch_.facet) != facets.end()) {
                placed.push_back(patch_.flatten(mesh_.triangulation.position(v)));
            }
        }
    }
}

void Recovery::survey(std::span<const std::uint8_t> present) {
    const Complex& c = mesh_.complex;
    std::vector<std::uint8_t> seen(c.segments.size(), 0);
    for (std::uint32_t f = 0; f < c.frames.size(); ++f) {
        if (c.facet_sides[f].empty()) continue;
        const bool is_known = !present.empty() && !options_.gabriel;
        if (is_known && present[f] != 0) {
            for (const Side& side : c.facet_sides[f]) seen[side.segment] = 1;
        } else if ((is_known && triangle_of(c, f)) || !settle_facet(f)) {
            mesh_.queue_facet(f);
            ++result_.missing_facets;
        }
        if (is_over()) return;
    }
    for (std::uint32_t id = 0; id < mesh_.pieces.size(); ++id) {
        const Piece& piece = mesh_.pieces[id];
        if (!piece.shield && seen[piece.owner] != 0 && piece.rule == PieceRule::present) continue;
        if (mesh_.is_satisfied(piece)) continue;
        mesh_.queue_piece(id);
        if (!piece.shield) ++result_.missing_segments;
    }
    spread_out(mesh_);
}

RecoveryResult Recovery::run(std::span<const std::uint8_t> present) {
    result_ = {};
    initial_points_ = mesh_.triangulation.size();
    if (area_ != nullptr) {
        is_center_.assign(initial_points_, 0);
        for (const std::uint32_t center : area_->ball_centers) is_center_[center] = 1;
    }
    if (options_.max_points != 0 && initial_points_ > options_.max_points) {
        fail(Outcome::over_budget, false, {ElementKind::vertex, 0}, no_index, mesh_.triangulation.position(0),
             "there are more points to begin with than max_points allows");
        return result_;
    }
    survey(present);
    while (!is_over()) {
        settle_pieces();
        if (is_over() || mesh_.facet_queue.empty()) break;
        watch();
        const std::uint32_t facet = mesh_.pop_facet();
        if (settle_facet(facet)) continue;
        refine();
        mesh_.queue_facet(facet);
    }
    return result_;
}

void Recovery::collect_triangles(std::uint32_t facet, std::vector<std::array<std::uint32_t, 3>>& triangles) const {
    const FacetWork* work = mesh_.find_work(facet);
    if (work != nullptr && !work->triangles.empty()) {
        triangles = work->triangles;
        return;
    }
    triangles.clear();
    if (const auto corners = triangle_of(mesh_.complex, facet)) triangles.push_back(*corners);
}

}  // namespace certa::conforming
