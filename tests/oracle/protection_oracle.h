#pragma once
// Checks protecting balls against conditions (i)-(vii) of Part I, 1.1.2, and the points and pieces of 1.1.3 against
// their definitions. Straightforward code over the definitions, quadratic or worse; each failure is one sentence.
#include <cstdint>
#include <string>
#include <vector>

#include "conforming/complex.h"
#include "conforming/protected_area.h"
#include "conforming/protecting_balls.h"

namespace certa::oracle {

struct Findings {
    std::vector<std::string> sentences;  // the first 20
    std::size_t count = 0;
    void add(const std::string& sentence) {
        if (++count <= 20) sentences.push_back(sentence);
    }
    std::string text() const;
};

/// Conditions (i) for `set` (closed under ends), (ii), (iii), (v), (vi), (vii); with `all_faces` also (iv), which costs
/// balls times faces.
Findings check_balls(const conforming::Complex& complex, const conforming::ProtectingBalls& balls,
                     const conforming::ProtectedSet& set, bool all_faces);

/// Chains, h-, p-, SOS- and leaving points, angles, orientation, and that the pieces around each centre fill exactly
/// the sectors of each facet there.
Findings check_area(const conforming::Complex& complex, const conforming::ProtectingBalls& balls,
                    const conforming::ProtectedArea& area);

/// Proposition 5: right-angled triangles are Gabriel among all points placed so far (quadratic).
Findings check_right_triangles_gabriel(const conforming::Complex& complex, const conforming::ProtectedArea& area);

}  // namespace certa::oracle
