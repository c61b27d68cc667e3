// The growing mesh. Insertions look at nothing but the conflict zone of the new point: pieces that may disappear are
// among the zone's edges, and constraint triangles that do disappear carry their facet as a mark.
#include "conforming/mesh_state.h"

#include <algorithm>
#include <cmath>

#include "core/assert.h"
#include "core/vector3.h"

namespace certa::conforming {

bool encroaches(const Point3& p, const Point3& a, const Point3& b, double rounding) {
    const Point3 pa = a - p, pb = b - p;
    const double size = norm(pa) + norm(pb);
    return dot(pa, pb) < -size * (rounding + 8e-16 * size);
}

MeshState::MeshState(const Complex& c) : complex(c) {
    double largest = 0.0;
    for (const Point3& p : c.points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    rounding = 8.0 * 0x1p-53 * largest;
}

void MeshState::reset(delaunay::Delaunay3 initial, const ProtectedArea* area, PieceRule segment_rule) {
    owners.clear();
    pieces.clear();
    piece_queue.clear();
    facet_queue.clear();
    works_.clear();
    adopted_.clear();
    gabriel_pieces_ = false;
    work_index_.assign(complex.frames.size(), no_index);
    facet_queued_.assign(complex.frames.size(), 0);
    first_pieces.assign(complex.segments.size(), no_index);
    piece_of_edge_ = core::PairMap(complex.segments.size());
    pieces.reserve(complex.segments.size() + complex.segments.size() / 2);

    triangulation = std::move(initial);
    if (area == nullptr) {
        for (std::uint32_t s = 0; s < complex.segments.size(); ++s) {
            if (complex.is_dropped(s)) continue;
            first_pieces[s] = add_piece(
                {complex.segments[s][0], complex.segments[s][1], no_index, s, no_index, false, false, segment_rule});
        }
        return;
    }
    for (const NewPoint& p : area->points) owners.push_back({p.on_segment(), p.owner});
    for (std::uint32_t s = 0; s < complex.segments.size(); ++s) {
        if (complex.is_dropped(s)) continue;
        const auto chain = area->chains[s];
        const auto balls = area->link_balls[s];
        std::uint32_t next = no_index;
        for (std::size_t i = chain.size() - 1; i-- > 0;) {
            // Inside balls, pieces are sides of right-angled triangles: present by Proposition 5.
            const PieceRule rule = balls[i] == no_index ? segment_rule : PieceRule::present;
            next = add_piece({chain[i], chain[i + 1], next, s, no_index, false, false, rule});
        }
        first_pieces[s] = next;
    }
    for (std::uint32_t f = 0; f < complex.frames.size(); ++f) {
        for (const ShieldEdge& e : area->shields[f]) {
            const std::uint32_t piece = add_piece({e.a, e.b, no_index, f, e.ball, true, false, PieceRule::gabriel});
            work_of(f).shields.push_back(piece);
        }
    }
    for (std::uint32_t v = 0; v < owners.size(); ++v) {
        if (!owners[v].on_segment) {
            work_of(owners[v].index).points.push_back(area->input_points + v);
        }
    }
}

std::uint32_t MeshState::add_piece(const Piece& piece) {
    const auto id = static_cast<std::uint32_t>(pieces.size());
    gabriel_pieces_ = gabriel_pieces_ || piece.rule == PieceRule::gabriel;
    pieces.push_back(piece);
    piece_of_edge_.set(piece.a, piece.b, id);
    return id;
}

void MeshState::find_touched(const delaunay::ConflictZone& zone) {
    touched_.clear();
    const auto look_up = [&](const std::array<std::uint32_t, 2>& edge) {
        const auto [a, b] = edge;
        const std::uint32_t id = piece_of_edge_.find(a, b);
        if (id == no_index) return;
        const Piece& piece = pieces[id];  // entries of pieces that were cut since are stale
        if ((piece.a == a && piece.b == b) || (piece.a == b && piece.b == a)) touched_.push_back(id);
    };
    for (const auto& edge : zone.edges) look_up(edge);
    removed_pieces_ = touched_.size();
    if (gabriel_pieces_) {
        for (const auto& edge : zone.border_edges) look_up(edge);
    }
}

MeshState::Inserted MeshState::insert(const Point3& place, std::uint32_t near, const Owner& owner) {
    const delaunay::ConflictZone& zone = triangulation.find_conflicts(place, near);
    if (zone.occupied) return {Insertion::occupied, zone.vertices.front()};
    for (const std::uint32_t v : zone.vertices) {
        if (distance(triangulation.position(v), place) <= std::max(min_feature, rounding))
            return {Insertion::too_close, v};
    }
    find_touched(zone);
    std::vector<std::uint32_t> marks = zone.removed_marks;
    if (heed_borders) marks.insert(marks.end(), zone.border_marks.begin(), zone.border_marks.end());
    const std::uint32_t vertex = triangulation.insert_in_conflicts();
    owners.push_back(owner);
    for (const std::uint32_t facet : marks) queue_facet(facet);
    for (std::size_t i = 0; i < touched_.size(); ++i) {
        const Piece& piece = pieces[touched_[i]];
        const bool hurt = piece.rule == PieceRule::gabriel &&
                          encroaches(place, triangulation.position(piece.a), triangulation.position(piece.b), rounding);
        if (hurt || i < removed_pieces_) queue_piece(touched_[i]);
    }
    return {Insertion::done, vertex};
}

void MeshState::cut(std::uint32_t id, std::uint32_t vertex) {
    const Piece whole = pieces[id];
    Piece second = whole;
    second.a = vertex;
    second.queued = false;
    const std::uint32_t other = add_piece(second);
    pieces[id].b = vertex;
    pieces[id].next = whole.shield ? no_index : other;
    piece_of_edge_.set(whole.a, vertex, id);
    if (whole.shield) {
        FacetWork& work = work_of(whole.owner);
        work.shields.push_back(other);
        work.points.push_back(vertex);
        queue_facet(whole.owner);
    } else {
        for (const std::uint32_t facet : complex.segment_facets[whole.owner]) queue_facet(facet);
    }
    const auto is_there = [&](const Piece& part, std::uint32_t end) {
        return part.rule == PieceRule::present ? triangulation.is_beside_last(end) : is_satisfied(part);
    };
    if (!is_there(pieces[id], whole.a)) queue_piece(id);
    if (!is_there(pieces[other], whole.b)) queue_piece(other);
}

void MeshState::set_crossing(std::uint32_t segment, std::uint32_t vertex) {
    const double there = parameter_of(segment, vertex);
    for (std::uint32_t id = first_pieces[segment]; id != no_index; id = pieces[id].next) {
        Piece& piece = pieces[id];
        const bool is_before = piece.b == vertex || parameter_of(segment, piece.b) < there;
        const std::uint32_t old = is_before ? piece.to : piece.from;
        if (is_before && (old == no_index || parameter_of(segment, old) > there)) piece.to = vertex;
        if (!is_before && (old == no_index || parameter_of(segment, old) < there)) piece.from = vertex;
    }
}

void MeshState::find_encroached(const Point3& place, std::uint32_t near, std::vector<std::uint32_t>& found) {
    found.clear();
    if (!gabriel_pieces_) return;
    const delaunay::ConflictZone& zone = triangulation.find_conflicts(place, near);
    if (zone.occupied) return;
    find_touched(zone);
    for (const std::uint32_t id : touched_) {
        const Piece& piece = pieces[id];
        if (piece.rule == PieceRule::gabriel &&
            encroaches(place, triangulation.position(piece.a), triangulation.position(piece.b), rounding)) {
            found.push_back(id);
        }
    }
}

bool MeshState::mark(std::uint32_t facet, const std::array<std::uint32_t, 3>& triangle) {
    const delaunay::FaceHandle face = triangulation.find_face(triangle[0], triangle[1], triangle[2]);
    if (face.cell == nullptr) return false;
    triangulation.mark_face(face, facet);
    return true;
}

void MeshState::queue_piece(std::uint32_t piece) {
    if (pieces[piece].queued) return;
    pieces[piece].queued = true;
    piece_queue.push_back(piece);
}

void MeshState::queue_facet(std::uint32_t facet) {
    if (facet_queued_[facet] != 0) return;
    facet_queued_[facet] = 1;
    facet_queue.push_back(facet);
}

std::uint32_t MeshState::pop_facet() {
    const std::uint32_t facet = facet_queue.front();
    facet_queue.pop_front();
    facet_queued_[facet] = 0;
    return facet;
}

std::uint32_t MeshState::pop_piece() {
    const std::uint32_t piece = piece_queue.front();
    piece_queue.pop_front();
    pieces[piece].queued = false;
    return piece;
}

bool MeshState::is_satisfied(const Piece& piece) const {
    if (piece.rule == PieceRule::present) return triangulation.has_edge(piece.a, piece.b);
    std::vector<delaunay::Delaunay3::LinkFace> link;
    triangulation.find_link(piece.a, piece.b, link);
    if (link.empty()) return false;
    const Point3 &a = triangulation.position(piece.a), &b = triangulation.position(piece.b);
    return std::none_of(link.begin(), link.end(),
                        [&](const auto& f) { return encroaches(triangulation.position(f.vertex), a, b, rounding); });
}

void MeshState::find_facets(std::uint32_t vertex, std::vector<std::uint32_t>& facets) const {
    facets.clear();
    if (vertex < complex.points.size()) {
        const auto row = complex.point_facets[vertex];
        facets.assign(row.begin(), row.end());
    } else {
        const Owner& owner = owners[vertex - complex.points.size()];
        if (owner.on_segment) {
            const auto row = complex.segment_facets[owner.index];
            facets.assign(row.begin(), row.end());
        } else {
            facets.assign(1, owner.index);
        }
    }
    const auto [begin, end] = adopted_.equal_range(vertex);
    for (auto i = begin; i != end; ++i) facets.push_back(i->second);
}

double MeshState::parameter_of(std::uint32_t segment, std::uint32_t vertex) const {
    const auto& [a, b] = complex.segments[segment];
    if (vertex == a) return 0.0;
    const Point3 direction = complex.points[b] - complex.points[a];
    const double length = norm(direction);
    if (vertex == b) return length;
    return dot(triangulation.position(vertex) - complex.points[a], direction) / length;
}

FacetWork& MeshState::work_of(std::uint32_t facet) {
    if (work_index_[facet] == no_index) {
        work_index_[facet] = static_cast<std::uint32_t>(works_.size());
        works_.emplace_back();
    }
    return works_[work_index_[facet]];
}

void MeshState::adopt(std::uint32_t facet, std::uint32_t vertex) {
    adopted_.emplace(vertex, facet);
    work_of(facet).points.push_back(vertex);
    queue_facet(facet);
}

}  // namespace certa::conforming
