// Files: formats by name and by content, TetGen's sets of files, and writing that is complete or has not happened.
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "documents.h"
#include "io/temporary_file.h"

namespace certa::test {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "certa-io-XXXXXX").string();
        ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
        folder = pattern;
    }
    void TearDown() override {
        fs::permissions(folder, fs::perms::owner_all);
        fs::remove_all(folder);
    }
    std::string path(const std::string& name) const { return (folder / name).string(); }
    void put(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
    }
    std::string get(const std::string& name) const {
        std::ifstream in(path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    std::vector<std::string> names() const {
        std::vector<std::string> found;
        for (const auto& entry : fs::directory_iterator(folder)) found.push_back(entry.path().filename().string());
        std::sort(found.begin(), found.end());
        return found;
    }
    MeshDocument triangle() const {
        MeshDocument document;
        document.complex.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
        add_facet(document.complex, {{VertexId{0}, VertexId{1}, VertexId{2}}});
        return document;
    }
    std::string reason_to_read(const std::string& name, const ReadOptions& options = {}) const {
        try {
            read_document(path(name), options);
        } catch (const IoError& error) {
            return error.what();
        }
        return "read";
    }

    fs::path folder;
};

TEST_F(Files, FormatsByExtension) {
    const std::vector<std::pair<std::string, Format>> table{
        {"a.off", Format::off},   {"A.OFF", Format::off},  {"a.obj", Format::obj},    {"a.ply", Format::ply},
        {"a.stl", Format::stl},   {"a.STL", Format::stl},  {"a.poly", Format::poly},  {"a.smesh", Format::smesh},
        {"a.node", Format::node}, {"a.ele", Format::node}, {"a.mesh", Format::medit}, {"a.vtu", Format::vtu},
        {"a.b.msh", Format::msh}, {"a.csv", Format::csv}};
    for (const auto& [name, format] : table) EXPECT_EQ(format_of(name), format) << name;
    for (const char* name : {"a", "a.txt", ".off", "", "off", "a.off/b"}) EXPECT_FALSE(format_of(name)) << name;
    for (int i = 0; i <= static_cast<int>(Format::csv); ++i)
        EXPECT_EQ(format_named(name_of(static_cast<Format>(i))), static_cast<Format>(i));
    EXPECT_FALSE(format_named("ofx"));
}

TEST_F(Files, FormatsByContent) {
    const MeshDocument document = triangle();
    for (const Format format :
         {Format::off, Format::obj, Format::ply, Format::stl, Format::medit, Format::vtu, Format::msh}) {
        put("thing", format_document(document, format));
        expect_same(read_document(path("thing")), document);
    }
    put("thing", format_document(document, Format::stl, {.encoding = Encoding::ascii}));
    expect_same(read_document(path("thing")), document);
    put("thing", "# x\n\n# y\nOFF 1 0 0\n0 0 0\n");
    EXPECT_EQ(read_document(path("thing")).complex.positions.size(), 1U);
    put("thing", "what is this");
    EXPECT_NE(reason_to_read("thing").find("--input-format"), std::string::npos);
    put("thing.stl", "OFF 1 0 0\n0 0 0\n");
    EXPECT_NE(reason_to_read("thing.stl").find("looks like off, not stl"), std::string::npos);
    EXPECT_EQ(read_document(path("thing.stl"), {.format = Format::off}).complex.positions.size(), 1U);
}

TEST_F(Files, TroubleNamesThePath) {
    EXPECT_NE(reason_to_read("missing.off").find("missing.off: cannot open: No such file"), std::string::npos);
    EXPECT_NE(reason_to_read(".", {.format = Format::off}).find("is a folder"), std::string::npos);
    EXPECT_THROW(write_document(path("a.xyz"), triangle()), IoError);
    EXPECT_THROW(write_document(path("no/such/folder/a.off"), triangle()), IoError);
    EXPECT_THROW(write_document(folder.string(), triangle(), {.format = Format::off}), IoError);
    EXPECT_TRUE(names().empty());
}

TEST_F(Files, PolyTakesItsPointsFromTheNodeFileBesideIt) {
    put("a.node", "3 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n");
    put("a.poly", "# points are elsewhere\n0 3 0 0\n1 0\n1\n3 0 1 2\n0\n0\n");
    put("a.smesh", "0 3 0 0\n1 0\n3 0 1 2\n0\n0\n");
    expect_same(read_document(path("a.poly")), triangle());
    expect_same(read_document(path("a.smesh")), triangle());
    put("b.poly", "0 3 0 0\n1 0\n1\n3 0 1 2\n0\n0\n");
    EXPECT_NE(reason_to_read("b.poly").find("b.poly:1:"), std::string::npos);
    put("a.node", "3 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 nan 0\n");
    EXPECT_NE(reason_to_read("a.poly").find("a.node:4:"), std::string::npos);
}

TEST_F(Files, NodeSetsAreReadAndWrittenTogether) {
    std::mt19937_64 random(5);
    MeshDocument document;
    add_points(document, 12, random);
    for (int i = 0; i < 5; ++i) add_polygon(document, 3, random);
    add_segments(document, 4, random);
    add_tetrahedra(document, 6, random);
    PiecewiseLinearComplex& complex = document.complex;
    complex.point_markers = random_markers(12, random);
    complex.facet_markers = random_markers(5, random);
    complex.segment_markers = random_markers(4, random);
    document.fields.push_back(integer_field("region", Location::tetrahedra, {1, 0, 2, 2, 1, 1}));
    document.fields.push_back(random_field("attribute", Location::tetrahedra, 6, 2, random));
    document.fields.push_back(random_field("attribute", Location::vertices, 12, 3, random));
    write_document(path("a.node"), document);
    EXPECT_EQ(names(), (std::vector<std::string>{"a.edge", "a.ele", "a.face", "a.node"}));
    for (const char* name : {"a.node", "a.ele", "a.face", "a.edge"}) expect_same(read_document(path(name)), document);

    // What the new mesh does not have must not come back from the old files.
    write_document(path("a.node"), triangle());
    expect_same(read_document(path("a.node")), triangle());
    EXPECT_EQ(get("a.ele"), "0 4 0\n");

    EXPECT_THROW(format_document(document, Format::node), IoError);
    put("lone.ele", "0 4 0\n");
    EXPECT_NE(reason_to_read("lone.ele").find("lone.node: cannot open"), std::string::npos);
    put("a.face", "1 0\n1 1 2 4\n");
    EXPECT_NE(reason_to_read("a.node").find("a.face:2:"), std::string::npos);
    put("a.face", "1 0\n1 1 2 3 4\n");
    EXPECT_NE(reason_to_read("a.node").find("a.face:2:"), std::string::npos);
    put("a.ele", "1 10 0\n1 1 2 3 3 1 1 1 1 1 1\n");
    EXPECT_NE(reason_to_read("a.node").find("only linear ones"), std::string::npos);
}

TEST_F(Files, ReplacesAFileOnlyWhenTheNewOneIsComplete) {
    put("a.off", "old");
    MeshDocument unwritable = triangle();
    unwritable.complex.segments.push_back({VertexId{0}, VertexId{1}});
    EXPECT_THROW(write_document(path("a.off"), unwritable), IoError);
    EXPECT_EQ(get("a.off"), "old");
    fs::permissions(path("a.off"), fs::perms::owner_read | fs::perms::owner_write | fs::perms::others_read);
    write_document(path("a.off"), triangle());
    EXPECT_EQ(get("a.off"), format_document(triangle(), Format::off));
    EXPECT_EQ(fs::status(path("a.off")).permissions(),
              fs::perms::owner_read | fs::perms::owner_write | fs::perms::others_read);
    EXPECT_EQ(names(), std::vector<std::string>{"a.off"});
}

TEST_F(Files, AllOfASetOrNothing) {
    put("b", "old");
    // The second of three cannot be created: nothing changes.
    EXPECT_THROW(io::write_files({{path("b"), "new"}, {path("none/x"), "new"}, {path("c"), "new"}}), IoError);
    EXPECT_EQ(get("b"), "old");
    EXPECT_EQ(names(), std::vector<std::string>{"b"});
}

TEST_F(Files, FollowsLinksAndWritesIntoPipes) {
    put("real.off", "old");
    fs::create_symlink("real.off", path("link.off"));
    write_document(path("link.off"), triangle());
    EXPECT_TRUE(fs::is_symlink(path("link.off")));
    EXPECT_EQ(get("real.off"), format_document(triangle(), Format::off));

    ASSERT_EQ(::mkfifo(path("pipe.off").c_str(), 0600), 0);
    MeshDocument received;
    std::thread reader([&] { received = read_document(path("pipe.off")); });
    write_document(path("pipe.off"), triangle());
    reader.join();
    expect_same(received, triangle());
    EXPECT_TRUE(fs::is_fifo(path("pipe.off")));
}

TEST_F(Files, LongNamesFit) {
    const std::string name(251, 'x');
    write_document(path(name + ".off"), triangle());
    expect_same(read_document(path(name + ".off")), triangle());
    EXPECT_EQ(names().size(), 1U);
}

TEST_F(Files, ASignalHandlerRemovesTemporaries) {
    // A child writes into a pipe that nobody reads while a temporary of the same set exists; its handler cleans up.
    ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
    const std::string big(1 << 20, 'x');
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        ::signal(SIGTERM, [](int) {
            io::remove_temporaries();
            ::_exit(7);
        });
        io::write_files({{path("a.off"), big}, {path("pipe"), big}});
        ::_exit(1);
    }
    const auto temporaries = [&] {
        int count = 0;
        for (const std::string& name : names()) count += name.ends_with(".tmp") ? 1 : 0;
        return count;
    };
    // Opening the reading end lets the child go on; not reading keeps it there.
    const int pipe = ::open(path("pipe").c_str(), O_RDONLY);
    ASSERT_GE(pipe, 0);
    char byte = 0;
    ASSERT_EQ(::read(pipe, &byte, 1), 1);
    EXPECT_EQ(temporaries(), 1);
    ::kill(child, SIGTERM);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ::close(pipe);
    EXPECT_EQ(WEXITSTATUS(status), 7);
    EXPECT_EQ(names(), std::vector<std::string>{"pipe"});
}

TEST_F(Files, StandardStreams) {
    const MeshDocument document = triangle();
    const std::string text = format_document(document, Format::off);
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        put("in", text);
        ::dup2(::open(path("in").c_str(), O_RDONLY), STDIN_FILENO);
        ::dup2(::open(path("out").c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
        write_document("-", read_document("-"), {.format = Format::obj});
        ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(get("out"), format_document(document, Format::obj));
    EXPECT_THROW(write_document("-", document), IoError);
}

}  // namespace
}  // namespace certa::test
