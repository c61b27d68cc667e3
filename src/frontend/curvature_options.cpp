// The options of `curvature`, and the grammar of regions on the command line.
//
// `--ball R|auto`, `--geodesic R` and `--rings K` set the neighbourhood together with its size, so they are spelled:
// text in, text out. Regions: union binds least, then intersection, then complement; parentheses group.
//   region  = term { "|" term }      term = factor { "&" factor }
//   factor  = "!" factor | "(" region ")" | "ball:x,y,z:R" | "box:x,y,z:x,y,z" | "halfspace:x,y,z:nx,ny,nz" |
//   "faces:FILE"
#include <array>

#include "frontend/option_table.h"

namespace certa::frontend {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr std::array<std::string_view, 4> rim_names{"dual", "half", "closed", "open"};
constexpr std::array<std::string_view, 3> weight_names{"indicator", "kernel2", "kernel4"};
constexpr std::array<std::string_view, 4> estimator_names{"normal-cycle", "corrected", "jet", "auto"};

constexpr std::string_view neighborhood_of(const CurvatureOptions& o) {
    switch (o.neighborhood) {
        case Neighborhood::rings:
            return "rings";
        case Neighborhood::geodesic:
            return "geodesic";
        default:
            return "ball";
    }
}

/// Sets a positive length as the radius of a neighbourhood.
void set_radius(CurvatureOptions& options, Neighborhood neighborhood, std::string_view name, std::string_view text) {
    const Length length = parse_length(name, text);
    if (!(length.value > 0.0))
        throw OptionError(std::string(name).append(": ").append(text).append(" is out of range; allowed is above 0"));
    options.neighborhood = neighborhood;
    options.radius = length;
}

std::uint64_t count_in(std::string_view name, std::string_view text, std::uint64_t low, std::uint64_t high) {
    const std::uint64_t value = parse_count(name, text);
    if (value < low || value > high)
        throw OptionError(std::string(name).append(": ").append(text).append(" is out of range; allowed is [") +
                          std::to_string(low) + ", " + std::to_string(high) + "]");
    return value;
}

constexpr std::array curvature_table{
    Option<CurvatureOptions>{
        "rings",
        "rings",
        Spelled<CurvatureOptions>{"K", [](const CurvatureOptions& o) { return std::to_string(o.rings); },
                                  [](CurvatureOptions& o, std::string_view name, std::string_view text) {
                                      o.rings = count_in(name, text, 1, 100);
                                  }},
        {},
        "rings of triangles around each vertex, unless a ball is asked for; in [1, 100]"},
    Option<CurvatureOptions>{
        "rim",
        "rim",
        Choice<CurvatureOptions>{rim_names, [](const CurvatureOptions& o) { return static_cast<std::size_t>(o.rim); },
                                 [](CurvatureOptions& o, std::size_t i) { o.rim = static_cast<Rim>(i); }},
        {},
        "what of the rings' border belongs to them: dual cells of all vertices within K steps, or "
        "triangles with border edges at half weight, in full, or not at all"},
    Option<CurvatureOptions>{
        "ball",
        "ball",
        Spelled<CurvatureOptions>{"LENGTH|auto",
                                  [](const CurvatureOptions& o) -> std::string {
                                      if (o.neighborhood == Neighborhood::automatic_ball) return "auto";
                                      return o.neighborhood == Neighborhood::ball ? text_of(o.radius) : "";
                                  },
                                  [](CurvatureOptions& o, std::string_view name, std::string_view text) {
                                      if (text == "auto")
                                          o.neighborhood = Neighborhood::automatic_ball;
                                      else
                                          set_radius(o, Neighborhood::ball, name, text);
                                  }},
        {},
        "instead of rings: the exact ball of this radius around each vertex (number or % of the "
        "diagonal), or a radius chosen per vertex"},
    Option<CurvatureOptions>{
        "geodesic",
        "geodesic",
        Spelled<CurvatureOptions>{"LENGTH",
                                  [](const CurvatureOptions& o) -> std::string {
                                      return o.neighborhood == Neighborhood::geodesic ? text_of(o.radius) : "";
                                  },
                                  [](CurvatureOptions& o, std::string_view name, std::string_view text) {
                                      set_radius(o, Neighborhood::geodesic, name, text);
                                  }},
        {},
        "instead of rings: what is within this distance along the surface (number or % of the diagonal)"},
    Option<CurvatureOptions>{
        "weight",
        "weight",
        Choice<CurvatureOptions>{weight_names,
                                 [](const CurvatureOptions& o) { return static_cast<std::size_t>(o.weight); },
                                 [](CurvatureOptions& o, std::size_t i) { o.weight = static_cast<Weight>(i); }},
        {},
        "of balls: plain, or a smooth kernel of order 2 or 4; of rings: plain or order 2"},
    Option<CurvatureOptions>{"all_sheets",
                             "all-sheets",
                             &CurvatureOptions::all_sheets,
                             {},
                             "of balls: all of the surface inside, not only what connects to the vertex"},
    Option<CurvatureOptions>{
        "estimator",
        "estimator",
        Choice<CurvatureOptions>{estimator_names,
                                 [](const CurvatureOptions& o) { return static_cast<std::size_t>(o.estimator); },
                                 [](CurvatureOptions& o, std::size_t i) { o.estimator = static_cast<Estimator>(i); }},
        {},
        "normal cycle, corrected normal current, polynomial jets, or chosen from the data's noise"},
    Option<CurvatureOptions>{
        "jet_degree",
        "jet-degree",
        Spelled<CurvatureOptions>{"2|3|4", [](const CurvatureOptions& o) { return std::to_string(o.jet_degree); },
                                  [](CurvatureOptions& o, std::string_view name, std::string_view text) {
                                      o.jet_degree = count_in(name, text, 2, 4);
                                  }},
        {},
        "of the estimator jet"},
    Option<CurvatureOptions>{"measures", "measures", &CurvatureOptions::measures, {}, "add measures beside densities"},
    Option<CurvatureOptions>{
        "tensors", "tensors", &CurvatureOptions::tensors, {}, "add both anisotropic measures (xx xy xz yy yz zz)"},
    Option<CurvatureOptions>{"bounds", "bounds", &CurvatureOptions::bounds, {}, "add the numbers of Theorem 13"},
    Option<CurvatureOptions>{
        "max_curvature",
        "max-curvature",
        Spelled<CurvatureOptions>{
            "NUMBER",
            [](const CurvatureOptions& o) { return o.max_curvature ? text_of(*o.max_curvature) : std::string(); },
            [](CurvatureOptions& o, std::string_view name, std::string_view text) {
                const double value = parse_number(name, text);
                if (!(value > 0.0))
                    throw OptionError(
                        std::string(name).append(": ").append(text).append(" is out of range; allowed is above 0"));
                o.max_curvature = value;
            }},
        {0.0, infinity, true, true},
        "of bounds: the largest curvature of the smooth surface, in 1 / unit (estimated without)"},
};

class RegionParser {
public:
    RegionParser(std::string_view text, const FaceReader& read_faces) : text_(text), read_faces_(read_faces) {}

    Region parse() {
        Region region = either();
        skip_spaces();
        if (at_ < text_.size()) refuse("expected '&', '|' or the end");
        return region;
    }

private:
    [[noreturn]] void refuse(const std::string& expected) const {
        throw OptionError("--region: " + expected + " at character " + std::to_string(at_ + 1) + " of '" +
                          std::string(text_) +
                          "'; a region is ball:x,y,z:R, box:x,y,z:x,y,z, halfspace:x,y,z:nx,ny,nz or faces:FILE, "
                          "joined by & | ! ( )");
    }
    void skip_spaces() {
        while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    }
    bool take(char c) {
        skip_spaces();
        if (at_ >= text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }

    Region either() {
        std::vector<Region> parts{both()};
        while (take('|')) parts.push_back(both());
        return parts.size() == 1 ? std::move(parts[0]) : make_union(std::move(parts));
    }
    Region both() {
        std::vector<Region> parts{factor()};
        while (take('&')) parts.push_back(factor());
        return parts.size() == 1 ? std::move(parts[0]) : make_intersection(std::move(parts));
    }
    Region factor() {
        if (++depth_ > 100) refuse("nested more than 100 deep");
        Region region;
        if (take('!')) {
            region = make_complement(factor());
        } else if (take('(')) {
            region = either();
            if (!take(')')) refuse("expected ')'");
        } else {
            region = primitive();
        }
        --depth_;
        return region;
    }

    Region primitive() {
        skip_spaces();
        const std::size_t end = std::min(text_.find_first_of("&|!()", at_), text_.size());
        std::string_view body = text_.substr(at_, end - at_);
        while (!body.empty() && body.back() == ' ') body.remove_suffix(1);
        const std::size_t colon = body.find(':');
        const std::string_view kind = body.substr(0, colon);
        if (colon == std::string_view::npos) refuse("expected a region");
        const std::string_view rest = body.substr(colon + 1);
        Region region;
        if (kind == "faces") {
            region = make_face_region(read_faces_(std::string(rest)));
        } else {
            const std::size_t second = rest.find(':');
            if (second == std::string_view::npos) refuse("expected two parts after '" + std::string(kind) + ":'");
            const Point3 first = point(rest.substr(0, second));
            const std::string_view last = rest.substr(second + 1);
            if (kind == "ball")
                region = make_ball_region(first, parse_number("--region", last));
            else if (kind == "box")
                region = make_box_region(first, point(last));
            else if (kind == "halfspace")
                region = make_half_space_region(first, point(last));
            else
                refuse("'" + std::string(kind) + "' is no region");
        }
        at_ = end;
        return region;
    }

    Point3 point(std::string_view text) const {
        std::array<double, 3> values{};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t comma = text.find(',');
            if ((comma == std::string_view::npos) != (i == 2)) refuse("expected three numbers, x,y,z");
            values[i] = parse_number("--region", text.substr(0, comma));
            if (i < 2) text = text.substr(comma + 1);
        }
        return {values[0], values[1], values[2]};
    }

    std::string_view text_;
    const FaceReader& read_faces_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

}  // namespace

std::span<const Option<CurvatureOptions>> curvature_options() { return curvature_table; }

std::string neighborhood_name(const CurvatureOptions& options) { return std::string(neighborhood_of(options)); }

Region parse_region(std::string_view text, const FaceReader& read_faces) {
    return RegionParser(text, read_faces).parse();
}

}  // namespace certa::frontend
