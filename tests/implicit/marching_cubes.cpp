// No table of cases: on each square of a cube the crossings are joined in a way that depends on the square alone, and
// the loops that this makes on the cube's surface are filled with fans.
#include "implicit/marching_cubes.h"

#include <array>
#include <map>

#include "implicit/field.h"

namespace certa::test {
namespace {

class Marcher {
public:
    Marcher(const Expression& f, const Point3& low, const Point3& high, int n) : low_(low), high_(high), n_(n) {
        const expression::Tape tape(f);
        implicit::Field field(tape);
        values_.resize(static_cast<std::size_t>(n + 1) * (n + 1) * (n + 1));
        for (int k = 0; k <= n; ++k) {
            for (int j = 0; j <= n; ++j) {
                for (int i = 0; i <= n; ++i) values_[number(i, j, k)] = field.value(place(i, j, k));
            }
        }
    }
    TriangleMesh run() {
        for (int k = 0; k < n_; ++k) {
            for (int j = 0; j < n_; ++j) {
                for (int i = 0; i < n_; ++i) march(i, j, k);
            }
        }
        return std::move(mesh_);
    }

private:
    std::size_t number(int i, int j, int k) const {
        return (static_cast<std::size_t>(k) * (n_ + 1) + static_cast<std::size_t>(j)) * (n_ + 1) +
               static_cast<std::size_t>(i);
    }
    Point3 place(int i, int j, int k) const {
        return {low_.x + (high_.x - low_.x) * i / n_, low_.y + (high_.y - low_.y) * j / n_,
                low_.z + (high_.z - low_.z) * k / n_};
    }
    Point3 place(std::size_t p) const {
        const auto m = static_cast<std::size_t>(n_ + 1);
        return place(static_cast<int>(p % m), static_cast<int>(p / m % m), static_cast<int>(p / m / m));
    }
    bool negative(std::size_t p) const { return values_[p] < 0; }

    VertexId vertex(std::size_t a, std::size_t b) {
        if (a > b) std::swap(a, b);
        const auto [found, added] =
            vertices_.emplace(std::pair(a, b), VertexId{static_cast<std::uint32_t>(mesh_.positions.size())});
        if (added) {
            const double t = values_[a] / (values_[a] - values_[b]);
            const Point3 p = place(a), q = place(b);
            mesh_.positions.push_back({p.x + t * (q.x - p.x), p.y + t * (q.y - p.y), p.z + t * (q.z - p.z)});
        }
        return found->second;
    }

    void march(int i, int j, int k) {
        // Corners of each face, counter-clockwise seen from outside.
        static constexpr int faces[6][4][3] = {
            {{0, 0, 0}, {0, 0, 1}, {0, 1, 1}, {0, 1, 0}}, {{1, 0, 0}, {1, 1, 0}, {1, 1, 1}, {1, 0, 1}},
            {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}}, {{0, 1, 0}, {0, 1, 1}, {1, 1, 1}, {1, 1, 0}},
            {{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}, {{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
        std::map<VertexId, VertexId> next;
        for (const auto& face : faces) {
            std::array<std::size_t, 4> c{};
            for (std::size_t q = 0; q < 4; ++q) c[q] = number(i + face[q][0], j + face[q][1], k + face[q][2]);
            for (std::size_t q = 0; q < 4; ++q) {
                if (negative(c[q]) || !negative(c[(q + 1) % 4])) continue;
                std::size_t r = (q + 1) % 4;  // into a run of negative corners at q, out of it at r
                while (negative(c[(r + 1) % 4])) r = (r + 1) % 4;
                next[vertex(c[r], c[(r + 1) % 4])] = vertex(c[q], c[(q + 1) % 4]);
            }
        }
        while (!next.empty()) {
            std::vector<VertexId> loop{next.begin()->first};
            for (auto at = next.begin(); at != next.end(); at = next.find(loop.back())) {
                loop.push_back(at->second);
                next.erase(at);
            }
            for (std::size_t q = 1; q + 2 < loop.size(); ++q)
                mesh_.triangles.push_back({loop[0], loop[q + 1], loop[q]});
        }
    }

    Point3 low_, high_;
    int n_;
    std::vector<double> values_;
    std::map<std::pair<std::size_t, std::size_t>, VertexId> vertices_;
    TriangleMesh mesh_;
};

}  // namespace

TriangleMesh march_cubes(const Expression& function, const Point3& low, const Point3& high, int n) {
    return Marcher(function, low, high, n).run();
}

}  // namespace certa::test
