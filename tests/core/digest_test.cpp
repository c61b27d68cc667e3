// The standard's own examples, and what changes a mesh's digest.
#include "core/digest.h"

#include <gtest/gtest.h>

namespace certa::core {
namespace {

TEST(Sha256, OfTheStandardsExamples) {
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(sha256(std::string(1000000, 'a')), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Digest, TellsMeshesApart) {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                            {{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{0}, VertexId{3}, VertexId{1}}}};
    const std::string digest = digest_of(mesh);
    TriangleMesh turned = mesh, moved = mesh, other = mesh, negative = mesh;
    std::swap(turned.triangles[1][0], turned.triangles[1][1]);
    EXPECT_EQ(digest_of(turned), digest);
    negative.positions[0].x = -0.0;
    EXPECT_EQ(digest_of(negative), digest);
    moved.positions[2].y = 1.0000000000000002;
    EXPECT_NE(digest_of(moved), digest);
    other.triangles[1][1] = VertexId{2};
    EXPECT_NE(digest_of(other), digest);
    std::swap(other.triangles[0], other.triangles[1]);
    EXPECT_NE(digest_of(other), digest);
}

}  // namespace
}  // namespace certa::core
