#pragma once
// Part III: functions of three variables whose zero set is meshed with certified topology. The language of expressions
// is that of docs/expressions.md.
#include <certa/error.h>
#include <certa/mesh.h>
#include <certa/run_control.h>
#include <certa/types.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace certa {

namespace expression {
class Node;
}

/// A text that is no expression: what is wrong and where. what() shows the line with a caret under the column.
class ExpressionError : public IoError {
public:
    /// `name` stands for the text, `line_text` is the line that the caret is drawn under.
    ExpressionError(std::string name, std::uint64_t line, std::uint64_t column, std::string reason,
                    std::string_view line_text);
    std::uint64_t column() const { return column_; }  ///< 1-based, in bytes

private:
    std::uint64_t column_;
};

/// A function of x, y, z as an immutable tree. Copies share; building is by operators, functions and parse_expression.
///
/// Definition: constants are exact: a decimal number in a text is that rational number, a double in C++ is that double.
///             Nothing is rounded before an evaluation.
/// Cost:       every operation O(1), but for constants; thread-safe.
class Expression {
public:
    /// The number as it is. Errors: InputError unless it is finite.
    Expression(double constant);  // NOLINT: numbers are expressions
    ///@{
    /// The coordinates and the circle's number.
    static Expression x();
    static Expression y();
    static Expression z();
    static Expression pi();
    ///@}

    /// From and to the library's own tree, which is not part of the public face.
    explicit Expression(std::shared_ptr<const expression::Node> node) : node_(std::move(node)) {}
    const std::shared_ptr<const expression::Node>& node() const { return node_; }  ///< the library's own tree

private:
    std::shared_ptr<const expression::Node> node_;
};

///@{
/// The operation, written down and not carried out. A quotient is defined where the divisor is not 0.
Expression operator-(const Expression& a);
Expression operator+(const Expression& a, const Expression& b);
Expression operator-(const Expression& a, const Expression& b);
Expression operator*(const Expression& a, const Expression& b);
Expression operator/(const Expression& a, const Expression& b);
///@}
/// Integer powers for every base, a^0 = 1; other constant exponents for a > 0 (1/2: the square root).
///
/// Errors: InputError when the exponent depends on x, y or z.
Expression pow(const Expression& a, const Expression& exponent);

///@{
/// The function as mathematics has it; `undefined` is the answer where it is not (sqrt and log below 0).
Expression sqrt(const Expression& a);
Expression exp(const Expression& a);
Expression log(const Expression& a);
Expression sin(const Expression& a);
Expression cos(const Expression& a);
Expression tan(const Expression& a);
Expression atan(const Expression& a);
Expression sinh(const Expression& a);
Expression cosh(const Expression& a);
Expression tanh(const Expression& a);
///@}

///@{
/// Solids that are negative inside, joined, cut and subtracted (a without b) with a rounded seam.
///
/// Definition: the union is the smooth minimum (a + b - sqrt((a - b)^2 + k^2)) / 2: at most k/2 below min(a, b), as
///             smooth as a and b are. The intersection is the smooth maximum, the difference that of a and -b.
/// Errors:     InputError when k is not a positive constant.
Expression smooth_union(const Expression& a, const Expression& b, const Expression& k);
Expression smooth_intersection(const Expression& a, const Expression& b, const Expression& k);
Expression smooth_difference(const Expression& a, const Expression& b, const Expression& k);
///@}

/// The expression that a generic C++ callable computes: it is called once, with expressions for x, y and z.
///
///     auto torus = make_expression([](auto x, auto y, auto z) {
///         auto q = x * x + y * y;
///         return pow(q + z * z + 0.84, 2) - 4.0 * q;
///     });
///
/// The contract is that of expressions: everything that certa proves holds for the real function, doubles in the code
/// standing for themselves. A callable that branches on its arguments does not compile.
template <class Function>
Expression make_expression(Function&& function) {
    return Expression(function(Expression::x(), Expression::y(), Expression::z()));
}

/// Reads an expression, or a file of definitions that ends with one (docs/expressions.md). `name` stands for the text
/// in messages.
///
/// Errors: ExpressionError with line and column.
/// Cost:   O(length).
Expression parse_expression(std::string_view text, const std::string& name = "expression");

/// The expression as a text with one definition per operation, every shared part once; parse_expression reads it back
/// to the same function with the same sharing.
std::string format_expression(const Expression& function);

/// Value and gradient in doubles.
struct PointValue {
    double value = 0.0;
    Point3 gradient;
};
/// Value and gradient at a point, rounded at every step: for drawing and searching, not for proofs.
///
/// Result: NaN where the function is undefined.
/// Cost:   O(operations), and as much memory; thread-safe.
PointValue evaluate(const Expression& function, const Point3& place);

/// What is proved about a zero set and its mesh.
enum class ImplicitVerdict : std::uint8_t {
    certified,  ///< the mesh is isotopic to the zero set in the box
    empty,      ///< the zero set in the box is proved to be empty
    undecided,  ///< nothing is claimed; the obstacles say where and why
};
/// The name as it is written here.
const char* name_of(ImplicitVerdict verdict);

/// A box where the proof got stuck, and why.
struct ImplicitObstacle {
    /// What stopped the proof there.
    enum class Reason : std::uint8_t {
        singular,        ///< f and its gradient cannot be told from 0 together
        meets_box,       ///< the surface crosses or touches the boundary of the box
        tangent_to_box,  ///< of a box that clips: the surface is tangent to a face or an edge of it, or meets a corner
        undefined,       ///< f cannot be shown to be defined there
        precision,       ///< the cell is as small as doubles allow
        budget,          ///< max_cells, max_depth, time_seconds or memory_bytes
        cancelled,       ///< by RunControl
    };
    Reason reason{};
    Point3 low, high;
};
/// The name as it is written here.
const char* name_of(ImplicitObstacle::Reason reason);

/// How the topology is certified.
enum class ImplicitEngine : std::uint8_t {
    growth,            ///< this project's: W by free growth, with a certificate
    plantinga_vegter,  ///< subdivision by small normal variation: the same claim by another theorem, no certificate
    thesis,            ///< as growth, with W by the thesis's watershed: for comparison; closed surfaces only
};
/// The name as the command has it: `_` becomes `-`.
const char* name_of(ImplicitEngine engine);

/// What `mesh_implicit` is asked for; the command and Python have the same names.
struct ImplicitOptions {
    /// Cells of the octree; about 100 bytes each, 2000 near the surface.
    std::optional<std::uint64_t> max_cells = 4'000'000;
    std::optional<std::uint64_t> max_depth = std::nullopt;  ///< automatic: as deep as doubles carry, at most 29
    bool certificate = false;                               ///< write ImplicitResult::certificate
    /// The mesh is refined and simplified to this distance from the zero set, as sampled; closed surfaces only. Without
    /// it: the raw mesh of the triangulation, as fine as the proof needs it and no finer.
    std::optional<double> error = std::nullopt;
    /// A length that mesh and zero set are to be proved to be within of each other, both ways; `error` follows from it.
    /// Not of products, nor where the box clips.
    std::optional<double> hausdorff = std::nullopt;
    ImplicitEngine engine = ImplicitEngine::growth;
    /// What may be taken, as estimated before every round; what is claimed is then the same or `budget`. Empty: no
    /// limit.
    std::optional<std::uint64_t> memory_bytes = std::nullopt;
    /// Where nothing can be certified, ImplicitResult::mesh is the best guess all the same, unless a million leaves
    /// are open; `verdict` says that nothing is claimed.
    bool uncertified = false;
    /// Seconds after which no further round begins; the result then depends on the machine. Empty: no limit.
    std::optional<std::uint64_t> time_seconds = std::nullopt;
    /// The surface may meet the box: what lies in the box is meshed, with loops in the box's boundary. Components,
    /// genera and loops are certified then (docs/implicit-theorem.md), isotopy is not claimed.
    bool clip = false;
};

/// A connected component of the surface.
struct ImplicitComponent {
    int genus = 0;       ///< of a clipped one: with a disk glued to each loop
    int inner_sign = 0;  ///< of f just inside; 0 unless isotopic
    int degree = 0;  ///< of the gradient over what the component encloses: inner_sign * (genus - 1); 0 unless isotopic
    std::optional<std::uint32_t> parent;  ///< the component next around it; empty unless isotopic
    int loops = 0;                        ///< boundary loops in the faces of a box that clips
};

/// Counts of one run.
struct ImplicitStatistics {
    std::uint64_t evaluations = 0;                         ///< enclosures of f over boxes, with or without derivatives
    std::uint64_t cells = 0, leaves = 0, open_leaves = 0;  ///< open: no sign of f is proved on the leaf
    std::uint64_t clusters = 0, rounds = 0, tetrahedra = 0;
};

/// A mesh of the zero set, and what is proved about it.
struct ImplicitResult {
    Outcome outcome = Outcome::done;
    ImplicitVerdict verdict = ImplicitVerdict::undecided;
    /// Certified: the mesh is isotopic to the zero set. If not, its components, genera and loops are those of the zero
    /// set (the type of the surface), but of a product, meshes of different factors may come close to each other or
    /// meet.
    bool isotopic = false;
    TriangleMesh mesh;  ///< faces towards f > 0; if isotopic, closed and embedded; empty unless certified
    std::vector<std::uint32_t> triangle_components;  ///< per triangle
    std::vector<ImplicitComponent> components;
    std::vector<ImplicitObstacle> obstacles;  ///< the first 1000
    std::size_t obstacle_count = 0;
    std::optional<double> hausdorff;  ///< proved: mesh and zero set are within this length of each other
    Point3 low, high;  ///< the box of the proof: that of the caller, enlarged by at most 2^-20 of its size
    ImplicitStatistics statistics;
    std::string certificate;  ///< JSON (docs/formats.md) for check_implicit; empty unless asked for and decided
};

/// Meshes {f = 0} in a box with certified topology.
///
/// Input:      a function, and a box whose boundary the surface does not meet.
/// Result:     see ImplicitResult.
/// Errors:     InputError for a box that makes no sense.
/// Guarantee:  `certified`: the zero set in the box is a smooth closed surface, ambient isotopic in the box to the mesh
///             as its doubles stand; `empty`: there is none (docs/implicit-theorem.md). Whatever cannot be proved is
///             `undecided`.
/// Cost:       grows with the logarithm of the distance to the next critical value for isolated critical points;
///             deterministic for any number of threads.
/// Source:     thesis, Part III; conditions and growth as in docs/implicit-theorem.md.
ImplicitResult mesh_implicit(const Expression& function, const Point3& low, const Point3& high,
                             const ImplicitOptions& options = {}, const RunControl& control = {});

/// What an independent reading of a certificate finds.
struct ImplicitCheck {
    std::vector<std::string> violations;  ///< at most 100 are kept; what is claimed and not proved, with its place
    std::size_t violation_count = 0;
    ImplicitVerdict verdict = ImplicitVerdict::undecided;  ///< proved by the check: certified, empty; else undecided
    bool isotopic = false;  ///< proved: the mesh is isotopic to the zero set; else components, genera and loops agree
    std::optional<double> hausdorff;  ///< proved as the certificate claims it: a bound on the distance, both ways
    std::vector<int> genera;          ///< per component of the mesh, sorted
    std::vector<int> loops;           ///< of a clipped surface, in the order of genera: boundary loops
    std::size_t leaves_checked = 0, marks_checked = 0, triangles_checked = 0;
    bool ok() const { return violation_count == 0; }  ///< all that the certificate claims is proved
};

/// Decides whether a certificate proves that a mesh is isotopic to the zero set of a function.
///
/// Input:      the mesh as its doubles stand, vertices in the order of the certificate; the function's text, read by
///             the checker's own reader; a certificate of mesh_implicit.
/// Result:     a cancelled check counts as one violation: nothing is proved.
/// Guarantee:  every condition of docs/implicit-theorem.md is decided anew: enclosures by MPFI, octree, triangulation,
///             replay of the marks, degrees, components, and exact positions. Shares no code with mesh_implicit.
/// Cost:       some times that of mesh_implicit; deterministic.
ImplicitCheck check_implicit(const TriangleMesh& mesh, std::string_view function, std::string_view certificate,
                             const RunControl& control = {});

/// Bytes that check_implicit takes beside its arguments, from the leaves that a certificate says it has and peaks
/// measured on large ones. Cost: O(length), a fraction of reading it.
std::uint64_t estimate_check_memory(std::string_view certificate);

}  // namespace certa
