#pragma once
// Part III: functions of three variables whose zero set is meshed with certified topology. The language of expressions
// is that of docs/expressions.md.
#include <certa/error.h>
#include <certa/types.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace certa {

namespace expression {
class Node;
}

/// A text that is no expression: what is wrong and where. what() shows the line with a caret under the column.
class ExpressionError : public IoError {
public:
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
    Expression(double constant);  // NOLINT: a finite number is an expression. Errors: InputError unless finite
    static Expression x();
    static Expression y();
    static Expression z();
    static Expression pi();

    explicit Expression(std::shared_ptr<const expression::Node> node) : node_(std::move(node)) {}
    const std::shared_ptr<const expression::Node>& node() const { return node_; }

private:
    std::shared_ptr<const expression::Node> node_;
};

Expression operator-(const Expression& a);
Expression operator+(const Expression& a, const Expression& b);
Expression operator-(const Expression& a, const Expression& b);
Expression operator*(const Expression& a, const Expression& b);
Expression operator/(const Expression& a, const Expression& b);
/// Integer powers for every base, a^0 = 1; other constant exponents for a > 0 (1/2: the square root).
/// Errors: InputError when the exponent depends on x, y or z.
Expression pow(const Expression& a, const Expression& exponent);
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

/// Smooth minimum (a + b - sqrt((a - b)^2 + k^2)) / 2, k > 0 constant: at most k/2 below min(a, b), as smooth as a and
/// b are. The union of solids that are negative inside; intersection is the maximum, difference a without b. Errors:
/// InputError when k is not a positive constant.
Expression smooth_union(const Expression& a, const Expression& b, const Expression& k);
Expression smooth_intersection(const Expression& a, const Expression& b, const Expression& k);
Expression smooth_difference(const Expression& a, const Expression& b, const Expression& k);

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

/// Value and gradient in doubles, rounded at every step: for drawing and searching, not for proofs. NaN where
/// undefined.
struct PointValue {
    double value = 0.0;
    Point3 gradient;
};
PointValue evaluate(const Expression& function, const Point3& place);

}  // namespace certa
