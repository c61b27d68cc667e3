// Tracing (thesis 4.2.1; remesh, stages 5 and 6).
//
// Plan: a step crosses one triangle by the trapezoidal rule: the chord's direction is the mean of the field's at entry
// and exit. The field along an edge is the same from both sides, so a line cannot bounce. Seeds, in this order: around
// umbilics (one per sector of the field), then wherever a finished line is exactly one spacing away, then the strongest
// curvature of parts without a line, then the middle of gaps that are still too wide. A line ends at features, at its
// own start (a loop), or when it comes too close to its family; afterwards ends are lengthened to the next line of the
// other family, so that they end in a node.
#include "remeshing/trace_lines.h"

#include <algorithm>
#include <numbers>
#include <queue>

#include "remeshing/segment_distance.h"

namespace certa::remeshing {
namespace {

/// A line's state between two triangles: about to enter face halfedge / 3.
struct Cursor {
    Index halfedge = no_index;
    Index crossing = no_index;
    double t = 0.0;   ///< along the half-edge
    Complex heading;  ///< unit, relative to the half-edge, pointing inwards
};

struct Seed {
    double priority = 0.0;
    std::uint64_t order = 0;
    Index edge = no_index;
    double t = 0.0;
    double least = 0.0;          ///< distance to the family that it needs, in spacings
    Index only_into = no_index;  ///< a face: trace on that side only
    friend bool operator<(const Seed& a, const Seed& b) {
        return a.priority != b.priority ? a.priority > b.priority : a.order > b.order;
    }
};

class FamilyTracer {
    static constexpr double reach = 1.3;  ///< of distances that are known, in spacings

public:
    FamilyTracer(Network& network, const DirectionField& field, const Spacing& spacing, const TraceRule& rule,
                 Family family, const RunControl& control)
        : network_(network),
          mesh_(network.mesh()),
          field_(field),
          spacing_(spacing.at[family]),
          other_spacing_(spacing.at[1 - family]),
          wanted_(spacing.wanted[family]),
          rule_(rule),
          family_(family),
          control_(control),
          proximity_(mesh_, spacing_, reach),
          seeded_(mesh_.edge_halfedges.size(), 0) {
        umbilic_faces_.assign(mesh_.faces.size(), false);
        for (const FieldUmbilic& u : field_.umbilics) umbilic_faces_[u.face] = true;
    }

    void run() {
        add_features();
        seed_guides();
        seed_umbilics();
        drain();
        fill_gaps();
    }
    /// Of all wedges where lines are wanted: the front knows, without samples.
    Coverage coverage() const;
    /// After both families: leads ends to the next line of the other one.
    void lengthen();
    /// Goes on from a vertex at an intrinsic angle of its wedge to the next line of the other family or feature.
    bool trace_from_vertex(Index corner, double angle);
    /// The direction of this family at a wedge that is nearest to an angle.
    double nearest_direction(Index wedge, double angle) const;

private:
    Complex direction(Index h, double t) const {
        const Complex z = field_.at(h, t);
        const double size = std::abs(z);
        if (!(size > 0.0)) return {1.0, 0.0};
        const Complex u = std::sqrt(z / size);
        return family_ == along_max ? u : Complex(-u.imag(), u.real());
    }
    double spacing_at(Index h, double t) const {
        return (1.0 - t) * spacing_[mesh_.wedges[h]] + t * spacing_[mesh_.wedges[next_of(h)]];
    }
    double other_spacing_at(Index h, double t) const {
        return (1.0 - t) * other_spacing_[mesh_.wedges[h]] + t * other_spacing_[mesh_.wedges[next_of(h)]];
    }
    Complex unit_side(Index h) const {
        const Index f = h / 3, i = h % 3;
        const Complex d = mesh_.local(f, (i + 1) % 3) - mesh_.local(f, i);
        return d / std::abs(d);
    }
    double along_halfedge(Index h, double t) const { return mesh_.along(h) ? t : 1.0 - t; }

    void add_features();
    void seed_guides();
    void seed_umbilics();
    void push_seed(Index edge, double t, double priority, double least, Index only_into = no_index);
    void seed_level_set();
    void drain();
    void fill_gaps();
    bool seed_usable(const Seed& seed) const;
    bool trace(const Seed& seed);
    Cursor start(Index line, Index h, double t, bool positive);
    /// Geometry of one step: where the chord leaves and how it heads there.
    void aim(const Cursor& cursor, Index& exit, double& t, Complex& heading) const;
    void leave(const Cursor& cursor, const Complex& direction, Index& exit, double& t) const;
    /// One triangle further. False: the line has ended (`end` says how).
    bool step(Index line, Cursor& cursor, LineEnd& end, const Complex* homing);
    LineEnd follow(Index line, Cursor cursor, bool is_first, bool may_close);
    bool close_loop(Index line, Cursor cursor);
    bool meets_other(Index line) const;
    bool run_to_other(Index line, Cursor cursor, double allowed);
    bool spirals(Index crossing, Index face, double nearest) const;
    double distance_at(Index crossing, Index face) const;
    void publish(Index line, std::size_t from, std::size_t upto);
    double chord_length(const Line& line, std::size_t k) const {
        return distance(network_.point(line.crossings[k]),
                        network_.point(line.crossings[(k + 1) % line.crossings.size()]));
    }

    Network& network_;
    const WorkMesh& mesh_;
    const DirectionField& field_;
    const std::vector<double>&spacing_, &other_spacing_;
    const std::vector<bool>& wanted_;
    const TraceRule& rule_;
    Family family_;
    const RunControl& control_;
    Proximity proximity_;
    std::vector<std::uint32_t> seeded_;  ///< per edge: number of the line whose level set put a seed here
    std::vector<bool> umbilic_faces_;
    std::priority_queue<Seed> seeds_;
    std::uint64_t order_ = 0;
    std::uint32_t line_number_ = 0;
};

void FamilyTracer::push_seed(Index edge, double t, double priority, double least, Index only_into) {
    seeds_.push({priority, order_++, edge, t, least, only_into});
}

/// Features that run along the family are lines of it already.
void FamilyTracer::add_features() {
    for (Index h = 0; h < mesh_.edges.size(); ++h) {
        if (!mesh_.is_feature(h)) continue;
        const Complex z = field_.at(h, 0.5);
        const bool parallel = family_ == along_max ? z.real() > 0.0 : z.real() < 0.0;
        if (!parallel) continue;
        const Segment segment{mesh_.points[mesh_.start_of(h)], mesh_.points[mesh_.end_of(h)], no_index, no_index,
                              no_index};
        proximity_.add(segment, h / 3, no_index);
    }
    proximity_.spread();
    ++line_number_;
    seed_level_set();
}

/// Beside vertices of guides, before everything else: on the edge that is crossed most squarely.
void FamilyTracer::seed_guides() {
    for (Index w = 0; w < field_.guided.size(); ++w) {
        if (field_.guided[w] != family_) continue;
        Index c = mesh_.wedge_first[w], best = no_index;
        const Index first = c;
        double best_sine = 0.5;
        do {
            const double sine = std::abs(direction(c, 0.02).imag());
            if (!mesh_.is_feature(c) && sine > best_sine) best_sine = sine, best = c;
            c = mesh_.next_corner(c);
        } while (c != no_index && c != first);
        if (best != no_index) push_seed(mesh_.edges[best], along_halfedge(best, 0.02), -2e9, 0.3);
    }
}

/// Where the field on the triangle's edges points at the umbilic: one line per sector.
void FamilyTracer::seed_umbilics() {
    for (const FieldUmbilic& u : field_.umbilics) {
        Complex center = 0.0;
        for (Index i = 0; i < 3; ++i) center += u.weights[i] * mesh_.local(u.face, i);
        for (Index i = 0; i < 3; ++i) {
            const Index h = 3 * u.face + i;
            const Complex o = mesh_.local(u.face, i), side = unit_side(h);
            const double length = mesh_.lengths[mesh_.edges[h]];
            const auto turn = [&](double t) {  // squared direction relative to the radius
                const Complex radius = (o + t * length * side - center) / side;
                Complex z = field_.at(h, t);
                if (family_ == along_min) z = -z;
                return z * std::conj(radius * radius);
            };
            constexpr int pieces = 16;
            Complex before = turn(0.0);
            for (int k = 1; k <= pieces; ++k) {
                const Complex after = turn(static_cast<double>(k) / pieces);
                if (before.real() + after.real() > 0.0 && (before.imag() <= 0.0) != (after.imag() <= 0.0)) {
                    const double part = before.imag() / (before.imag() - after.imag());
                    const double t = (k - 1 + part) / pieces;
                    const Index w = mesh_.wedges[h];
                    if (!mesh_.is_feature(h) && wanted_[w])
                        push_seed(mesh_.edges[h], along_halfedge(h, t), -1e9 + spacing_[w], 0.3,
                                  mesh_.opposites[h] / 3);
                }
                before = after;
            }
        }
    }
}

/// Edges on which the distance to the nearest line passes the spacing.
void FamilyTracer::seed_level_set() {
    for (const Index w : proximity_.changed()) {
        const double here = proximity_.relative(w);
        Index c = mesh_.wedge_first[w];
        const Index first = c;
        const auto look = [&](Index h, bool forward) {
            const Index e = mesh_.edges[h];
            if (seeded_[e] == line_number_) return;
            const double there = proximity_.relative(mesh_.wedges[forward ? next_of(h) : h]);
            if ((here < 1.0) == (there < 1.0)) return;
            seeded_[e] = line_number_;
            const double part = there > 1e100 ? 1.0 : (1.0 - here) / (there - here);
            const double t = std::clamp(forward ? part : 1.0 - part, 1e-3, 1.0 - 1e-3);
            push_seed(e, along_halfedge(h, t), static_cast<double>(line_number_), rule_.seed_below);
        };
        do {
            look(c, true);
            const Index n = mesh_.next_corner(c);
            if (n == no_index) look(previous_of(c), false);
            c = n;
        } while (c != no_index && c != first);
    }
}

void FamilyTracer::drain() {
    std::size_t count = 0;
    while (!seeds_.empty() && !control_.cancelled()) {
        const Seed seed = seeds_.top();
        seeds_.pop();
        if (seed_usable(seed) && trace(seed)) {
            ++line_number_;
            seed_level_set();
        }
        if (++count % 4096 == 0) control_.report("lines", family_ == along_max ? 0.25 : 0.75);
    }
}

/// Parts without any line, strongest curvature first; then gaps that are too wide, widest first.
void FamilyTracer::fill_gaps() {
    for (int round = 0; round < 64 && !control_.cancelled(); ++round) {
        bool any = false;
        for (Index w = 0; w < mesh_.wedge_count(); ++w) {
            const double relative = proximity_.relative(w);
            if (relative < rule_.gap_above || !wanted_[w]) continue;
            // Of the edges around, the one that the line crosses most squarely.
            Index c = mesh_.wedge_first[w];
            const Index first = c;
            Index best = no_index;
            double best_sine = 0.3;
            bool best_feature = true;
            do {
                const double sine = std::abs(direction(c, 0.25).imag());
                const bool feature = mesh_.is_feature(c);
                if (sine > 0.3 && (best_feature != feature ? best_feature : sine > best_sine))
                    best_sine = sine, best = c, best_feature = feature;
                c = mesh_.next_corner(c);
            } while (c != no_index && c != first);
            if (best == no_index) continue;
            if (best_feature) {  // a narrow patch without edges across the line: begin on its rim
                push_seed(mesh_.edges[best], along_halfedge(best, 0.5), 1e6 - 1.0, 0.97 * rule_.gap_above, best / 3);
                any = true;
                continue;
            }
            const double priority = relative > 1e100 ? spacing_[w] : 1e6 - relative;
            push_seed(mesh_.edges[best], along_halfedge(best, 0.02), priority, 0.97 * rule_.gap_above);
            any = true;
        }
        if (!any) return;
        const std::uint32_t before = line_number_;
        drain();
        if (line_number_ == before) return;
    }
}

Coverage FamilyTracer::coverage() const {
    Coverage out;
    for (Index w = 0; w < mesh_.wedge_count(); ++w) {
        if (!wanted_[w]) continue;
        const double relative = proximity_.relative(w);
        if (relative > reach) {
            ++out.uncovered;
        } else {
            out.farthest = std::max(out.farthest, relative);
        }
    }
    return out;
}

bool FamilyTracer::seed_usable(const Seed& seed) const {
    Index h = mesh_.edge_halfedges[seed.edge];
    if (mesh_.is_feature(h) && seed.only_into != no_index && h / 3 != seed.only_into) h = mesh_.opposites[h];
    if (h != mesh_.edge_halfedges[seed.edge])
        return std::abs(direction(h, 1.0 - seed.t).imag()) >= 0.15 &&
               proximity_.distance_from(mesh_.point_on(seed.edge, seed.t), h / 3) >=
                   seed.least * spacing_at(h, 1.0 - seed.t);
    if (!wanted_[mesh_.wedges[h]] && !wanted_[mesh_.wedges[next_of(h)]]) return false;
    const double spacing = spacing_at(h, seed.t);
    if (std::abs(direction(h, seed.t).imag()) < 0.15) return false;
    const Point3 p = mesh_.point_on(seed.edge, seed.t);
    double nearest = proximity_.distance_from(p, h / 3);
    const Index o = mesh_.opposites[h];
    if (o != no_index && !mesh_.is_feature(h)) nearest = std::min(nearest, proximity_.distance_from(p, o / 3));
    return nearest >= seed.least * spacing;
}

Cursor FamilyTracer::start(Index line, Index h, double t, bool positive) {
    Complex u = direction(h, t);
    if ((u.imag() > 0.0) != positive) u = -u;
    static_cast<void>(line);
    Cursor cursor;
    cursor.halfedge = h;
    cursor.t = t;
    cursor.heading = u;
    return cursor;
}

void FamilyTracer::leave(const Cursor& cursor, const Complex& direction, Index& exit, double& t) const {
    const Index f = cursor.halfedge / 3, i = cursor.halfedge % 3;
    const Complex a = mesh_.local(f, i), b = mesh_.local(f, (i + 1) % 3), o = mesh_.local(f, (i + 2) % 3);
    const Complex p = a + cursor.t * (b - a);
    const auto wedge = [](const Complex& x, const Complex& y) { return x.real() * y.imag() - x.imag() * y.real(); };
    const bool right = wedge(direction, o - p) > 0.0;  // the apex lies to the left: leave by the side behind b
    exit = right ? next_of(cursor.halfedge) : previous_of(cursor.halfedge);
    const Complex from = right ? b : o, to = right ? o : a;
    const double x = wedge(direction, from - p), y = wedge(direction, to - p);
    t = x == y ? 0.5 : x / (x - y);
    if (!(t > 0.0)) t = 0.0;
    if (t > 1.0) t = 1.0;
}

void FamilyTracer::aim(const Cursor& cursor, Index& exit, double& t, Complex& heading) const {
    const Complex side = unit_side(cursor.halfedge);
    Complex in = direction(cursor.halfedge, cursor.t);
    if ((in * std::conj(cursor.heading)).real() < 0.0) in = -in;
    if (in.imag() < 0.02) in = cursor.heading;
    in *= side;
    Complex chord = in;
    for (int round = 0; round < 2; ++round) {
        leave(cursor, chord, exit, t);
        Complex out = direction(exit, t) * unit_side(exit);
        if ((out * std::conj(in)).real() < 0.0) out = -out;
        if ((out * std::conj(in)).real() < 0.3) break;  // an umbilic is near: straight on
        chord = in + out;
        chord /= std::abs(chord);
    }
    leave(cursor, chord, exit, t);
    Complex out = direction(exit, t);
    const Complex straight = chord / unit_side(exit);
    if ((out * std::conj(straight)).real() < 0.0) out = -out;
    if (out.imag() > -0.02) out = straight;
    if (out.imag() > -1e-3) out = Complex(out.real(), -1e-3);
    heading = -out / std::abs(out);
}

bool FamilyTracer::step(Index line, Cursor& cursor, LineEnd& end, const Complex* homing) {
    Index exit = no_index;
    double t = 0.0;
    Complex heading;
    if (homing != nullptr) {
        leave(cursor, *homing, exit, t);
        heading = -*homing / unit_side(exit);
    } else {
        aim(cursor, exit, t, heading);
    }
    double place = along_halfedge(exit, t), low = 0.0, high = 1.0;
    if (!network_.find_exit(family_, cursor.halfedge, cursor.crossing, exit, place, low, high)) {
        end = LineEnd::stuck;
        return false;
    }
    const Index edge = mesh_.edges[exit];
    const Index crossing = network_.add_crossing(line, edge, place, low, high);
    if (crossing == no_index) {
        end = LineEnd::stuck;
        return false;
    }
    Line& l = network_.lines()[line];
    network_.add_chord(line, cursor.halfedge / 3, cursor.crossing, crossing);
    l.crossings.push_back(crossing);
    l.faces.push_back(cursor.halfedge / 3);
    if (mesh_.is_feature(exit)) {
        end = LineEnd::feature;
        return false;
    }
    const Index over = mesh_.opposites[exit];
    cursor.halfedge = over;
    cursor.crossing = crossing;
    cursor.t = along_halfedge(over, network_.crossing(crossing).t);
    if (!(heading.imag() > 0.0)) heading = {heading.real(), 1e-3};
    cursor.heading = heading / std::abs(heading);
    return true;
}

double FamilyTracer::distance_at(Index crossing, Index face) const {
    const Point3 p = network_.point(crossing);
    double nearest = proximity_.distance_from(p, face);
    const Index line = network_.crossing(crossing).line;
    for (Index c = network_.first_chord(face); c != no_index; c = network_.chord(c).next) {
        const Chord& chord = network_.chord(c);
        if (chord.line == line || network_.family_of(chord) != family_) continue;
        const Point3 a = network_.point(chord.from), d = network_.point(chord.to) - a;
        const double length = dot(d, d), s = length > 0.0 ? std::clamp(dot(p - a, d) / length, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, norm(p - a - s * d));
    }
    return nearest;
}

/// Whether a line has come back to a face time and again, each time closer to itself than lines may be: where a turn is
/// shorter than the two spacings that a line does not see of itself, as on a spike, it would never end.
bool FamilyTracer::spirals(Index crossing, Index face, double nearest) const {
    constexpr int most = 4;
    const Point3 p = network_.point(crossing);
    const Index line = network_.crossing(crossing).line;
    int turns = 0;
    for (Index c = network_.first_chord(face); c != no_index; c = network_.chord(c).next) {
        const Chord& chord = network_.chord(c);
        turns +=
            chord.line == line && distance_to_segment(p, network_.point(chord.from), network_.point(chord.to)) < nearest
                ? 1
                : 0;
    }
    return turns > most;
}

/// Makes a range of chords known to proximity.
void FamilyTracer::publish(Index line, std::size_t from, std::size_t upto) {
    const Line& l = network_.lines()[line];
    Index previous = no_index;
    for (std::size_t k = from; k < upto; ++k) {
        const Segment segment{network_.point(l.crossings[k]), network_.point(l.crossings[(k + 1) % l.crossings.size()]),
                              line, no_index, no_index};
        previous = proximity_.add(segment, l.faces[k], previous);
    }
    proximity_.spread();
}

/// Leads the line along straight surface paths to its own first crossing.
bool FamilyTracer::close_loop(Index line, Cursor cursor) {
    const Index target = network_.lines()[line].crossings.front();
    const Index edge = network_.crossing(target).edge;
    const Point3 goal = network_.point(target);
    const std::size_t before = network_.lines()[line].crossings.size();
    for (int guard = 0; guard < 400; ++guard) {
        const Index f = cursor.halfedge / 3;
        for (Index h = 3 * f; h < 3 * f + 3; ++h) {
            if (mesh_.edges[h] != edge || h == cursor.halfedge) continue;
            // The last chord must not cross its family either.
            Index exit = h;
            double place = network_.crossing(target).t, low = 0.0, high = 1.0;
            Line& l = network_.lines()[line];
            if (l.faces.front() == f) break;  // it would close on the wrong side
            if (network_.find_exit(family_, cursor.halfedge, cursor.crossing, exit, place, low, high) && exit == h &&
                place == network_.crossing(target).t) {
                network_.add_chord(line, f, cursor.crossing, target);
                l.faces.push_back(f);
                l.closed = true;
                return true;
            }
            break;
        }
        // The direction of the goal in the plane of the face.
        const Index i = cursor.halfedge % 3;
        const Point3 &a = mesh_.points[mesh_.faces[f][i]], &b = mesh_.points[mesh_.faces[f][(i + 1) % 3]],
                     &c = mesh_.points[mesh_.faces[f][(i + 2) % 3]];
        const Point3 x = b - a, n = cross(x, c - a), y = cross(n, x);
        const Point3 p = a + cursor.t * x, d = goal - p;
        if (!(norm(x) > 0.0) || !(norm(y) > 0.0)) break;
        Complex homing(dot(d, x) / norm(x), dot(d, y) / norm(y));
        if (!(std::abs(homing) > 0.0)) break;
        homing /= std::abs(homing);
        if (homing.imag() < 0.05) break;
        homing *= unit_side(cursor.halfedge);
        LineEnd end = LineEnd::none;
        if (!step(line, cursor, end, &homing)) break;
    }
    while (network_.lines()[line].crossings.size() > before) network_.remove_last(line);
    return false;
}

LineEnd FamilyTracer::follow(Index line, Cursor cursor, bool is_first, bool may_close) {
    double length = 0.0, unpublished = 0.0;
    std::size_t tail = network_.lines()[line].crossings.size() - 1;  // the first chord that is not published
    const double least = 0.7 * other_spacing_at(cursor.halfedge, cursor.t);
    LineEnd end = LineEnd::none;
    const std::size_t limit = 20 * mesh_.faces.size() + 1000;
    const Point3 origin = network_.point(network_.lines()[line].crossings.front());
    for (std::size_t guard = 0; guard < limit; ++guard) {
        if ((guard & 1023U) == 1023U && control_.cancelled()) return LineEnd::stuck;
        const Cursor before = cursor;
        const bool going = step(line, cursor, end, nullptr);
        if (end == LineEnd::stuck) return end;
        const Line& l = network_.lines()[line];
        const std::size_t last = l.faces.size() - 1;
        const Point3 p = network_.point(l.crossings.back()), q = network_.point(l.crossings[l.crossings.size() - 2]);
        const double piece = distance(p, q);
        const double spacing = spacing_at(before.halfedge, before.t);
        const double nearest = distance_at(l.crossings.back(), l.faces.back());
        if (!going) return end;
        length += piece;
        if (is_first && may_close) {
            const Point3 to = origin - p;
            const double gap = norm(to), ahead = piece > 0.0 ? dot(to, p - q) / piece : 0.0;
            if (gap < std::max(spacing, 2.0 * mesh_.mean_edge) && length > 2.5 * gap && ahead > 0.0 &&
                gap * gap - ahead * ahead < 0.25 * spacing * spacing && ahead > 0.5 * gap &&
                length > 4.0 * mesh_.mean_edge && close_loop(line, cursor))
                return LineEnd::none;
        }
        if (nearest < rule_.stop_below * spacing ||
            spirals(l.crossings.back(), l.faces.back(), rule_.stop_below * spacing)) {
            network_.remove_last(line);
            return LineEnd::near_line;
        }
        unpublished += piece;
        // A line does not see its own last two spacings, nor, on its way from the seed, its first two.
        if (is_first && length < 2.0 * spacing) tail = last + 1, unpublished = 0.0;
        if (unpublished > 4.0 * spacing && length > least) {
            double kept = 0.0;
            std::size_t k = last + 1;
            while (k > tail && kept < 2.0 * spacing) kept += chord_length(l, --k);
            publish(line, tail, k);
            tail = k;
            unpublished = kept;
        }
    }
    return LineEnd::stuck;
}

bool FamilyTracer::trace(const Seed& seed) {
    const Index line = network_.add_line(family_);
    const Index crossing = network_.add_crossing(line, seed.edge, seed.t, 0.0, 1.0);
    if (crossing == no_index) return false;
    network_.lines()[line].crossings.push_back(crossing);
    const double t = network_.crossing(crossing).t;
    const Index h = mesh_.edge_halfedges[seed.edge], o = mesh_.opposites[h];
    std::vector<Index> sides;
    const bool feature = mesh_.is_feature(h);
    for (const Index side : {h, o})
        if (side != no_index && (seed.only_into == no_index || side / 3 == seed.only_into)) sides.push_back(side);
    if (feature && sides.size() == 2) sides.pop_back();
    for (std::size_t k = 0; k < sides.size(); ++k) {
        Line* l = &network_.lines()[line];
        if (k == 1) {
            if (l->closed) break;
            std::reverse(l->crossings.begin(), l->crossings.end());
            std::reverse(l->faces.begin(), l->faces.end());
        }
        Cursor cursor = start(line, sides[k], along_halfedge(sides[k], t), true);
        cursor.crossing = crossing;
        // From a crease a line leads away to one side: it has no other to come back to.
        const LineEnd end = follow(line, cursor, k == 0, !feature);
        l = &network_.lines()[line];
        if (k == 1) l->ends[0] = l->ends[1];
        l->ends[1] = end;
        if (sides.size() == 1) l->ends[0] = feature ? LineEnd::feature : LineEnd::umbilic;
    }
    const Line& l = network_.lines()[line];
    double length = 0.0;
    for (std::size_t k = 0; k < l.faces.size(); ++k) length += chord_length(l, k);
    const bool anchored = l.ends[0] == LineEnd::feature && l.ends[1] == LineEnd::feature;
    if (!l.closed && (l.faces.empty() || (!anchored && length < 0.7 * other_spacing_at(h, t)))) {
        network_.remove_line(line);
        return false;
    }
    publish(line, 0, l.faces.size());
    return true;
}

/// Whether the line's last chord crosses a chord of the other family.
bool FamilyTracer::meets_other(Index line) const {
    const Line& l = network_.lines()[line];
    const Index f = l.faces.back();
    const Chord own{f, line, l.crossings[l.crossings.size() - 2], l.crossings.back(), no_index};
    for (Index c = network_.first_chord(f); c != no_index; c = network_.chord(c).next)
        if (network_.family_of(network_.chord(c)) != family_ && network_.cross(network_.chord(c), own)) return true;
    return false;
}

/// Until a line of the other family or a feature is met, at most `allowed` further.
bool FamilyTracer::run_to_other(Index line, Cursor cursor, double allowed) {
    double length = 0.0;
    for (int guard = 0; guard < 100000 && length < allowed; ++guard) {
        LineEnd end = LineEnd::none;
        const bool going = step(line, cursor, end, nullptr);
        if (end == LineEnd::stuck) return false;
        if (!going) {
            network_.lines()[line].ends[1] = LineEnd::feature;
            return true;
        }
        const Line& now = network_.lines()[line];
        length += chord_length(now, now.faces.size() - 1);
        if (meets_other(line)) return true;
    }
    return false;
}

void FamilyTracer::lengthen() {
    const std::size_t count = network_.lines().size();
    for (Index line = 0; line < count; ++line) {
        if (network_.lines()[line].family != family_ || network_.lines()[line].closed ||
            network_.lines()[line].faces.empty())
            continue;
        for (int side = 0; side < 2; ++side) {
            Line& l = network_.lines()[line];
            std::reverse(l.crossings.begin(), l.crossings.end());
            std::reverse(l.faces.begin(), l.faces.end());
            std::swap(l.ends[0], l.ends[1]);
            if (l.ends[1] != LineEnd::near_line && l.ends[1] != LineEnd::umbilic) continue;
            const std::size_t before = l.crossings.size();
            // On from the last chord: its direction across the last edge.
            const Index last = l.crossings.back(), face = l.faces.back();
            Index h = 3 * face;
            while (mesh_.edges[h] != network_.crossing(last).edge) ++h;
            if (mesh_.is_feature(h)) continue;
            Cursor cursor;
            cursor.halfedge = mesh_.opposites[h];
            cursor.crossing = last;
            cursor.t = along_halfedge(cursor.halfedge, network_.crossing(last).t);
            Complex u = direction(cursor.halfedge, cursor.t);
            cursor.heading = u.imag() < 0.0 ? -u : u;
            if (cursor.heading.imag() < 0.02) cursor.heading = Complex(0.0, 1.0);
            const double allowed = 1.5 * other_spacing_at(cursor.halfedge, cursor.t);
            const bool reached = run_to_other(line, cursor, allowed);
            if (!reached)
                while (network_.lines()[line].crossings.size() > before) network_.remove_last(line);
        }
    }
}

double FamilyTracer::nearest_direction(Index wedge, double angle) const {
    double own = 0.5 * std::arg(field_.squares[wedge]) + (family_ == along_min ? 0.5 * std::numbers::pi : 0.0);
    own += std::numbers::pi * std::round((angle - own) / std::numbers::pi);
    return own;
}

bool FamilyTracer::trace_from_vertex(Index corner, double angle) {
    const Index vertex = mesh_.start_of(corner), face = corner / 3, i = corner % 3;
    const Index line = network_.add_line(family_);
    const Index start = network_.add_vertex_crossing(line, vertex);
    network_.lines()[line].crossings.push_back(start);
    network_.lines()[line].ends[0] = LineEnd::feature;
    // The first chord, from the vertex to the opposite side.
    const Complex o = mesh_.local(face, i), p = mesh_.local(face, (i + 1) % 3), q = mesh_.local(face, (i + 2) % 3);
    const double part = (angle - mesh_.corner_start[corner]) / mesh_.corner_angle[corner];
    const Complex d = std::polar(1.0, std::arg(p - o) + part * std::arg((q - o) * std::conj(p - o)));
    const auto wedge = [](const Complex& x, const Complex& y) { return x.real() * y.imag() - x.imag() * y.real(); };
    const double x = wedge(d, p - o), y = wedge(d, q - o);
    Index exit = next_of(corner);
    const Index wanted = exit;
    double place = along_halfedge(exit, x == y ? 0.5 : std::clamp(x / (x - y), 0.0, 1.0)), low = 0.0, high = 1.0;
    Index first = no_index;
    if (network_.find_exit(family_, corner, start, exit, place, low, high) && exit == wanted)
        first = network_.add_crossing(line, mesh_.edges[exit], place, low, high);
    bool reached = false;
    if (first != no_index) {
        network_.add_chord(line, face, start, first);
        Line& l = network_.lines()[line];
        l.crossings.push_back(first);
        l.faces.push_back(face);
        reached = mesh_.is_feature(exit);
        if (!reached) {
            Cursor cursor;
            cursor.halfedge = mesh_.opposites[exit];
            cursor.crossing = first;
            cursor.t = along_halfedge(cursor.halfedge, network_.crossing(first).t);
            cursor.heading = -d / unit_side(exit);
            if (cursor.heading.imag() < 0.02) cursor.heading = Complex(0.0, 1.0);
            reached = meets_other(line) || run_to_other(line, cursor, mesh_.diagonal);
        }
    }
    if (!reached) network_.remove_line(line);
    return reached;
}

/// Every crease that ends in nothing goes on as a line.
void extend_tips(const WorkMesh& mesh, FamilyTracer& max, FamilyTracer& min) {
    std::vector<Index> degree(mesh.points.size(), 0);
    for (Index e = 0; e < mesh.edge_curves.size(); ++e) {
        if (mesh.edge_curves[e] == no_index) continue;
        ++degree[mesh.start_of(mesh.edge_halfedges[e])];
        ++degree[mesh.end_of(mesh.edge_halfedges[e])];
    }
    for (Index w = 0; w < mesh.wedge_count(); ++w) {
        if (degree[mesh.wedge_vertices[w]] != 1) continue;
        Index last = mesh.wedge_first[w];
        while (mesh.next_corner(last) != no_index) last = mesh.next_corner(last);
        const double middle = 0.5 * (mesh.corner_start[last] + mesh.corner_angle[last]);
        double a = max.nearest_direction(w, middle), b = min.nearest_direction(w, middle);
        FamilyTracer *best = &max, *other = &min;
        if (std::abs(b - middle) < std::abs(a - middle)) std::swap(a, b), std::swap(best, other);
        const auto corner_at = [&](double angle) {
            Index c = mesh.wedge_first[w];
            while (c != no_index && angle >= mesh.corner_start[c] + mesh.corner_angle[c]) c = mesh.next_corner(c);
            return c;
        };
        const Index c = corner_at(a), d = corner_at(b);
        if (c != no_index && best->trace_from_vertex(c, a)) continue;
        if (d != no_index) other->trace_from_vertex(d, b);
    }
}

}  // namespace

Network trace_lines(const WorkMesh& mesh, const DirectionField& field, const Spacing& spacing, const TraceRule& rule,
                    const RunControl& control) {
    Network network(mesh);
    FamilyTracer max(network, field, spacing, rule, along_max, control);
    FamilyTracer min(network, field, spacing, rule, along_min, control);
    max.run();
    min.run();
    max.lengthen();
    min.lengthen();
    extend_tips(mesh, max, min);
    network.coverage(along_max) = max.coverage();
    network.coverage(along_min) = min.coverage();
    return network;
}

}  // namespace certa::remeshing
