// Isotropic samples (thesis 4.2.2) and the triangles around them (4.3.2).
//
// Plan: candidates are the umbilics and, where spherical parts are to have points, the centroids of triangles there.
// Each is located in a face of the graph; its distances to the face's sides, to features and to samples are reckoned in
// the spacing that is wanted there. Best fit first, until nothing fits. The first sample of a face is joined to all its
// corners, further ones are inserted into the triangles, edges flipped while opposite angles exceed pi.
#include "remeshing/isotropic.h"

#include <algorithm>
#include <numbers>

#include "core/triangle_tree.h"
#include "remeshing/segment_distance.h"
#include "remeshing/triangulate.h"

namespace certa::remeshing {
namespace {

double wedge_product(const Complex& x, const Complex& y) { return x.real() * y.imag() - x.imag() * y.real(); }

Complex local_place(const WorkMesh& mesh, const SurfacePlace& place) {
    Complex sum = 0.0;
    for (Index i = 0; i < 3; ++i) sum += place.weights[i] * mesh.local(place.face, i);
    return sum;
}

}  // namespace

FaceLocator::FaceLocator(const Graph& graph, const Network& network, const std::vector<std::vector<Index>>& faces)
    : graph_(graph),
      network_(network),
      mesh_(network.mesh()),
      known_(mesh_.faces.size(), no_index),
      seen_(mesh_.faces.size(), 0) {
    face_of_half_.assign(2 * graph.edges.size(), no_index);
    for (Index f = 0; f < faces.size(); ++f)
        for (const Index h : faces[f]) face_of_half_[h] = f;
    collect_pieces();
    collect_features();
}

void FaceLocator::collect_pieces() {
    const auto crossing_place = [&](Index face, Index crossing) {
        const PerimeterPlace p = network_.place(crossing, face, 0);
        const Complex a = mesh_.local(face, p.side), b = mesh_.local(face, (p.side + 1) % 3);
        return a + (p.key < 0.0 ? 1.0 + p.key : p.key) * (b - a);
    };
    std::vector<Piece> found;
    for (Index e = 0; e < graph_.edges.size(); ++e) {
        const GraphEdge& edge = graph_.edges[e];
        if (!edge.alive() || edge.line == no_index) continue;
        const Line& line = network_.lines()[edge.line];
        const std::size_t count = line.faces.size();
        for (double k = std::floor(edge.from); k < edge.to; k += 1.0) {
            const std::size_t number = static_cast<std::size_t>(k) % count;
            Piece piece{line.faces[number], 2 * e, {}, {}, no_index, no_index};
            const auto end = [&](bool inside, Index node, Index crossing, Complex& place, Index& kept) {
                const SurfacePlace& own = graph_.nodes[node].place;
                if (inside && own.face == piece.face) {
                    place = local_place(mesh_, own);
                    return;
                }
                place = crossing_place(piece.face, crossing);
                if (!inside) kept = crossing;
            };
            end(k < edge.from, edge.a, line.crossings[number], piece.from, piece.from_crossing);
            end(edge.to < k + 1.0, edge.b, line.crossings[(number + 1) % line.crossings.size()], piece.to,
                piece.to_crossing);
            found.push_back(piece);
        }
    }
    offsets_.assign(mesh_.faces.size() + 1, 0);
    for (const Piece& piece : found) ++offsets_[piece.face + 1];
    for (std::size_t f = 0; f < mesh_.faces.size(); ++f) offsets_[f + 1] += offsets_[f];
    pieces_.resize(found.size());
    std::vector<Index> at(offsets_.begin(), offsets_.end() - 1);
    for (const Piece& piece : found) pieces_[at[piece.face]++] = piece;
}

void FaceLocator::collect_features() {
    places_on_curve_.assign(mesh_.edge_halfedges.size(), no_index);
    for (const FeatureCurve& curve : mesh_.curves)
        for (Index k = 0; k < curve.edges.size(); ++k) places_on_curve_[curve.edges[k]] = k;
    curve_edges_.resize(mesh_.curves.size());
    for (Index e = 0; e < graph_.edges.size(); ++e)
        if (graph_.edges[e].alive() && graph_.edges[e].curve != no_index)
            curve_edges_[graph_.edges[e].curve].push_back(e);
}

Index FaceLocator::on_feature(Index h, double t) const {
    const Index number = mesh_.edge_curves[mesh_.edges[h]], k = places_on_curve_[mesh_.edges[h]];
    const FeatureCurve& curve = mesh_.curves[number];
    const bool along = mesh_.start_of(h) == curve.vertices[k];
    const double count = static_cast<double>(curve.edges.size()), at = k + (along ? t : 1.0 - t);
    for (const Index e : curve_edges_[number]) {
        const GraphEdge& edge = graph_.edges[e];
        const bool within = (edge.from <= at && at <= edge.to) || (edge.from <= at + count && at + count <= edge.to);
        if (within) return along ? 2 * e : 2 * e + 1;
    }
    return no_index;
}

Index FaceLocator::walk(Index face, Index side, double t) const {
    const auto is_feature = [&](Index s) { return mesh_.is_feature(3 * face + s % 3); };
    if (is_feature(side)) return on_feature(3 * face + side, t);
    // How far counter-clockwise, in sides.
    double nearest = 3.0;
    Index half = no_index;
    const auto consider = [&](Index crossing, Index inward) {
        if (crossing == no_index) return;
        const PerimeterPlace p = network_.place(crossing, face, side);
        double ahead = p.side + (p.key < 0.0 ? 1.0 + p.key : p.key) - t;
        if (ahead < 0.0) ahead += 3.0;
        if (ahead < nearest) nearest = ahead, half = inward;
    };
    for (const Piece& piece : pieces_of(face)) {
        consider(piece.from_crossing, piece.half);
        consider(piece.to_crossing, piece.half ^ 1U);
    }
    for (Index s = 1; s < 3; ++s)
        if (is_feature(side + s) && s - t < nearest) {
            nearest = s - t;
            half = on_feature(3 * face + (side + s) % 3, 1e-9);
        }
    return half;
}

Index FaceLocator::find(const SurfacePlace& place) {
    const auto face_of = [&](Index half) { return half == no_index ? no_index : face_of_half_[half]; };
    const auto own = pieces_of(place.face);
    if (!own.empty()) {
        // Straight to the middle of a side: the first piece in the way, or else what the perimeter has next.
        const Complex x = local_place(mesh_, place);
        Index side = 0;
        while (side < 2 && mesh_.is_feature(3 * place.face + side)) ++side;
        const Complex goal = 0.5 * (mesh_.local(place.face, side) + mesh_.local(place.face, (side + 1) % 3));
        double nearest = 1.0;
        Index half = no_index;
        for (const Piece& piece : own) {
            const Complex d = piece.to - piece.from, way = goal - x;
            const double before = wedge_product(d, x - piece.from), after = wedge_product(d, goal - piece.from);
            const double low = wedge_product(way, piece.from - x), high = wedge_product(way, piece.to - x);
            if ((before > 0.0) == (after > 0.0) || (low > 0.0) == (high > 0.0)) continue;
            const double part = before / (before - after);
            if (part < nearest) nearest = part, half = before > 0.0 ? piece.half : piece.half ^ 1U;
        }
        return face_of(half != no_index ? half : walk(place.face, side, 0.5));
    }
    return flood(place.face);
}

Index FaceLocator::flood(Index face) {
    if (known_[face] != no_index) return known_[face];
    ++stamp_;
    std::vector<Index> queue{face};
    seen_[face] = stamp_;
    Index found = no_index;
    const auto take = [&](Index half) {
        if (half != no_index) found = face_of_half_[half];
    };
    for (std::size_t at = 0; at < queue.size() && found == no_index; ++at)
        for (Index h = 3 * queue[at]; h < 3 * queue[at] + 3 && found == no_index; ++h) {
            if (mesh_.is_feature(h)) {
                take(on_feature(h, 0.5));
                continue;
            }
            const Index over = mesh_.opposites[h], next = over / 3;
            if (seen_[next] == stamp_) continue;
            seen_[next] = stamp_;
            if (!pieces_of(next).empty())
                take(walk(next, over % 3, 1.0));
            else if (known_[next] != no_index)
                found = known_[next];
            else
                queue.push_back(next);
        }
    for (const Index f : queue) known_[f] = found;
    return found;
}

std::vector<bool> find_spherical_wedges(const DirectionField& field) {
    constexpr double largest_ratio = 0.15;  // of the difference of curvatures to their sum
    std::vector<bool> spherical(field.k_max.size());
    for (std::size_t w = 0; w < spherical.size(); ++w)
        spherical[w] = field.k_max[w] - field.k_min[w] < largest_ratio * std::abs(field.k_max[w] + field.k_min[w]);
    return spherical;
}

namespace {

/// What might become a sample.
struct Candidate {
    IsotropicSample sample;
    double desired = 0.0, actual = 0.0;
};

class SampleChooser {
public:
    SampleChooser(const Graph& graph, const Network& network, const std::vector<std::vector<Index>>& faces,
                  const DirectionField& field, const Spacing& spacing, const SampleRule& rule)
        : graph_(graph),
          mesh_(network.mesh()),
          faces_(faces),
          field_(field),
          spacing_(spacing),
          rule_(rule),
          locator_(graph, network, faces) {}

    std::vector<IsotropicSample> choose() {
        for (const FieldUmbilic& u : field_.umbilics) add({u.face, u.weights});
        if (rule_.everywhere) {
            const std::vector<bool> spherical = find_spherical_wedges(field_);
            for (Index f = 0; f < mesh_.face_count(); ++f)
                if (spherical[mesh_.wedges[3 * f]] && spherical[mesh_.wedges[3 * f + 1]] &&
                    spherical[mesh_.wedges[3 * f + 2]])
                    add({f, {1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0}});
        }
        std::vector<IsotropicSample> chosen;
        for (std::size_t best = best_fit(); best < candidates_.size(); best = best_fit()) {
            chosen.push_back(candidates_[best].sample);
            for (Candidate& c : candidates_)
                c.actual = std::min(c.actual, distance(c.sample.point, chosen.back().point));
        }
        return chosen;
    }

private:
    void add(const SurfacePlace& place) {
        Candidate c;
        bool curved = false;
        for (Index i = 0; i < 3; ++i) {
            const Index w = mesh_.wedges[3 * place.face + i];
            curved = curved || spacing_.curved[w];
            c.desired += place.weights[i] * std::min(spacing_.at[0][w], spacing_.at[1][w]);
            c.sample.point = c.sample.point + place.weights[i] * mesh_.points[mesh_.faces[place.face][i]];
        }
        if (!curved) return;
        c.sample.place = place;
        c.sample.face = locator_.find(place);
        if (c.sample.face == no_index) return;
        const auto& face = faces_[c.sample.face];
        if (!rule_.everywhere && (face.size() == 4 || !(missed_by(face, c.sample.point) > rule_.error))) return;
        c.actual = 1e300;
        for (const Index h : face)
            c.actual = std::min(c.actual, distance_to_segment(c.sample.point, graph_.nodes[graph_.tail(h)].point,
                                                              graph_.nodes[graph_.head(h)].point));
        if (c.actual >= rule_.least_fit * c.desired) candidates_.push_back(c);
    }
    /// The distance of a point from the face as short diagonals would cut it.
    double missed_by(const std::vector<Index>& face, const Point3& p) const {
        std::vector<Point3> points;
        std::vector<Index> ring;
        for (const Index h : face) {
            ring.push_back(static_cast<Index>(points.size()));
            points.push_back(graph_.nodes[graph_.tail(h)].point);
        }
        std::vector<std::array<Index, 3>> cut;
        triangulate_polygon(points, ring, core::TriangleTree({}, {}), cut);
        std::vector<Triangle> triangles;
        for (const auto& t : cut) triangles.push_back({VertexId{t[0]}, VertexId{t[1]}, VertexId{t[2]}});
        return std::sqrt(core::TriangleTree(points, triangles).find_nearest(p).squared_distance);
    }
    /// Of those with room enough the one whose distance is nearest to what is desired.
    std::size_t best_fit() const {
        std::size_t best = candidates_.size();
        double least = 1e300;
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            const Candidate& c = candidates_[i];
            if (c.actual < rule_.least_fit * c.desired) continue;
            const double miss = std::abs(std::log(c.actual / c.desired));
            if (miss < least) least = miss, best = i;
        }
        return best;
    }

    const Graph& graph_;
    const WorkMesh& mesh_;
    const std::vector<std::vector<Index>>& faces_;
    const DirectionField& field_;
    const Spacing& spacing_;
    const SampleRule& rule_;
    FaceLocator locator_;
    std::vector<Candidate> candidates_;
};

/// Triangles of one polygon around points within it.
class StarTriangulation {
public:
    StarTriangulation(std::vector<Point3>& points, std::span<const Index> ring) : points_(points) {
        Point3 area;
        for (std::size_t i = 1; i + 1 < ring.size(); ++i)
            area = area + cross(points[ring[i]] - points[ring[0]], points[ring[i + 1]] - points[ring[0]]);
        const double length = norm(area);
        if (length > 0.0) normal_ = (1.0 / length) * area;
        ring_.assign(ring.begin(), ring.end());
    }

    /// Joins a vertex to all corners; false where one of the triangles would not face the polygon's way.
    bool begin(Index center) {
        for (std::size_t i = 0; i < ring_.size(); ++i)
            triangles_.push_back({ring_[i], ring_[(i + 1) % ring_.size()], center});
        return std::all_of(triangles_.begin(), triangles_.end(), [&](const auto& t) { return height(t) > 0.0; });
    }
    void insert(Index vertex) {
        const Point3& p = points_[vertex];
        std::size_t at = 0;
        double least = 1e300;
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            const double d = overhang(triangles_[t], p);
            if (d < least) least = d, at = t;
        }
        const auto [a, b, c] = triangles_[at];
        triangles_[at] = {a, b, vertex};
        triangles_.push_back({b, c, vertex});
        triangles_.push_back({c, a, vertex});
        for (int guard = 0; guard < 200 && flip_one(); ++guard) continue;
    }
    const std::vector<std::array<Index, 3>>& triangles() const { return triangles_; }

private:
    using Corners = std::array<Index, 3>;
    Point3 area_of(const Corners& t) const {
        return cross(points_[t[1]] - points_[t[0]], points_[t[2]] - points_[t[0]]);
    }
    double height(const Corners& t) const {
        const Point3 area = area_of(t);
        const double size = norm(area);
        return size > 0.0 ? dot(area, normal_) / size - 0.1 : -1.0;
    }
    /// How far a point is beyond the sides of a triangle, seen along the triangle's normal.
    double overhang(const Corners& t, const Point3& p) const {
        const Point3 area = area_of(t);
        double worst = -1e300;
        for (std::size_t i = 0; i < 3; ++i) {
            const Point3 &a = points_[t[i]], &b = points_[t[(i + 1) % 3]];
            const Point3 out = cross(b - a, area);
            const double size = norm(out);
            if (size > 0.0) worst = std::max(worst, dot(p - a, out) / size);
        }
        return worst;
    }
    double angle(Index apex, Index a, Index b) const {
        const Point3 u = points_[a] - points_[apex], v = points_[b] - points_[apex];
        return std::atan2(norm(cross(u, v)), dot(u, v));
    }
    /// The edge with the largest sum of opposite angles, if that is above pi and what would come is not there yet.
    bool flip_one() {
        double most = std::numbers::pi + 1e-9;
        std::array<std::size_t, 4> best{};
        bool any = false;
        for (std::size_t s = 0; s < triangles_.size(); ++s)
            for (std::size_t t = s + 1; t < triangles_.size(); ++t)
                for (std::size_t i = 0; i < 3; ++i)
                    for (std::size_t j = 0; j < 3; ++j) {
                        const auto &x = triangles_[s], &y = triangles_[t];
                        if (x[i] != y[(j + 1) % 3] || x[(i + 1) % 3] != y[j]) continue;
                        const Index p = x[(i + 2) % 3], q = y[(j + 2) % 3];
                        const double sum = angle(p, x[i], x[(i + 1) % 3]) + angle(q, y[j], y[(j + 1) % 3]);
                        const Corners left{x[i], q, p}, right{q, x[(i + 1) % 3], p};
                        if (sum <= most || is_edge(p, q) || !(height(left) > 0.0) || !(height(right) > 0.0)) continue;
                        most = sum, best = {s, t, i, j}, any = true;
                    }
        if (!any) return false;
        const auto [s, t, i, j] = best;
        const Corners x = triangles_[s], y = triangles_[t];
        const Index p = x[(i + 2) % 3], q = y[(j + 2) % 3];
        triangles_[s] = {x[i], q, p};
        triangles_[t] = {q, x[(i + 1) % 3], p};
        return true;
    }
    bool is_edge(Index a, Index b) const {
        return std::any_of(triangles_.begin(), triangles_.end(), [&](const Corners& t) {
            return std::find(t.begin(), t.end(), a) != t.end() && std::find(t.begin(), t.end(), b) != t.end();
        });
    }

    std::vector<Point3>& points_;
    std::vector<Index> ring_;
    std::vector<Corners> triangles_;
    Point3 normal_;
};

}  // namespace

std::vector<IsotropicSample> choose_samples(const Graph& graph, const Network& network,
                                            const std::vector<std::vector<Index>>& faces, const DirectionField& field,
                                            const Spacing& spacing, const SampleRule& rule) {
    return SampleChooser(graph, network, faces, field, spacing, rule).choose();
}

std::size_t triangulate_around(const std::vector<IsotropicSample>& samples, CoarseMesh& polygons) {
    Index faces = 0;
    for (const IsotropicSample& sample : samples) faces = std::max(faces, sample.face + 1);
    std::vector<std::vector<Index>> of_face(faces), of_polygon(polygons.polygon_count());
    for (Index s = 0; s < samples.size(); ++s) of_face[samples[s].face].push_back(s);
    for (std::size_t i = 0; i < polygons.polygon_count(); ++i)
        if (polygons.parent(i) < faces) of_polygon[i].swap(of_face[polygons.parent(i)]);
    CoarseMesh out = polygons.without_polygons();
    std::size_t used = 0;
    for (std::size_t i = 0; i < polygons.polygon_count(); ++i) {
        const auto ring = polygons.polygon(i);
        bool done = false;
        if (!of_polygon[i].empty()) {
            const std::size_t before = out.points.size();
            for (const Index s : of_polygon[i]) out.add_vertex(samples[s].point, samples[s].place);
            StarTriangulation star(out.points, ring);
            done = star.begin(static_cast<Index>(before));
            for (std::size_t v = before + 1; done && v < out.points.size(); ++v) star.insert(static_cast<Index>(v));
            if (done) {
                for (const auto& t : star.triangles()) out.add_polygon(t, polygons.parent(i));
                used += out.points.size() - before;
            } else {
                out.points.resize(before), out.kinds.resize(before), out.curves.resize(before),
                    out.places.resize(before);
            }
        }
        if (!done) out.add_polygon(ring, polygons.parent(i));
    }
    polygons = std::move(out);
    return used;
}

}  // namespace certa::remeshing
