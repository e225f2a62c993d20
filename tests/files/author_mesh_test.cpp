// SPDX-License-Identifier: Apache-2.0
#include "files/author_mesh.h"

#include <gtest/gtest.h>

#include "files/clip_output.h"
#include "tests/test_directory.h"

namespace sac {
namespace {

// Two squares that share an edge, with names, texture coordinates, a normal and a line that goes on.
const std::string kObj =
    "# by hand\n"
    "mtllib red.mtl\n"
    "o roof\n"
    "v 0 0 0\n"
    "v\t1 0 \\\n 0 0.5 0.25 1\n"
    "v 1 1 0\n"
    "vn 0 0 1\n"
    "v 0 1 0 # a comment\n"
    "v 2 0 0.5\n"
    "v 2 1 0.5\n"
    "vt 0.25 0.5\n"
    "g left\n"
    "usemtl red\n"
    "f 1/1/1 2/1/1 3/1/1 4/1/1\n"
    "g right\n"
    "f 2/1/1 5/1/1 6/1/1 3/1/1\n";

class AuthorMeshTest : public testing::Test {
 protected:
  // The mesh as a stream may have it: other vertex and triangle order, positions slightly off.
  AuthorMeshTest() : path_(directory_.Write("roof.obj", kObj)) {
    decoded_.positions = {{2, 1.01F, 0.5F}, {1, 1, 0.01F}, {0, 0, 0}, {2, 0, 0.49F}, {0, 1, 0}, {1, 0.01F, 0}};
    // The triangles of the file are 0 1 2, 0 2 3, 1 4 5, 1 5 2.
    decoded_.triangles = {{2, 5, 1}, {1, 4, 2}, {0, 5, 3}, {1, 5, 0}};
  }

  TestDirectory directory_;
  std::string path_;
  Mesh decoded_;
  AuthorMesh author_;
};

TEST_F(AuthorMeshTest, OrderIsFound) {
  const Status status = OpenAuthorMesh(path_, decoded_, {}, author_);
  ASSERT_TRUE(status.ok()) << status.message();
  EXPECT_EQ(author_.order, (VertexOrder{5, 2, 0, 4, 3, 1}));
  EXPECT_TRUE(author_.warnings.empty());
  ASSERT_TRUE(author_.obj);
  EXPECT_EQ(author_.obj->vertices(), 6U);
  EXPECT_EQ(author_.obj->normals(), (std::vector<Vec3f>{{0, 0, 1}}));
}

TEST_F(AuthorMeshTest, TheTextStaysButForThePositions) {
  ASSERT_TRUE(OpenAuthorMesh(path_, decoded_, {}, author_).ok());
  const Positions positions = {{9, 8, 7}, {0.1F, 2, 3}, {1, 1, 1}, {4, 4, 4}, {5, 5, 5}, {6, 6, 6}};
  EXPECT_EQ(author_.obj->Format(positions, {0, 0, 0.5}),
            "# by hand\n"
            "mtllib red.mtl\n"
            "o roof\n"
            "v 9 8 7.5\n"
            "v\t0.1 2 3.5 0.5 0.25 1\n"
            "v 1 1 1.5\n"
            "vn 0 0 1\n"
            "v 4 4 4.5 # a comment\n"
            "v 5 5 5.5\n"
            "v 6 6 6.5\n"
            "vt 0.25 0.5\n"
            "g left\n"
            "usemtl red\n"
            "f 1/1/1 2/1/1 3/1/1 4/1/1\n"
            "g right\n"
            "f 2/1/1 5/1/1 6/1/1 3/1/1\n");
  author_.obj->ReplaceNormals({{0, 1, 0}});
  EXPECT_NE(author_.obj->Format(positions, {}).find("vn 0 1 0\n"), std::string::npos);
}

TEST_F(AuthorMeshTest, CachesHaveTheAuthorsMeshBesideThem) {
  ASSERT_TRUE(OpenAuthorMesh(path_, decoded_, {}, author_).ok());
  Mesh mesh = author_.file.mesh;
  mesh.positions = ToInputOrder(decoded_.positions, author_.order);
  ClipOutput::Settings settings;
  settings.obj = &*author_.obj;
  std::unique_ptr<ClipOutput> output;
  ASSERT_TRUE(ClipOutput::Open(directory_.Path("out.pc2"), mesh, settings, output).ok());
  ASSERT_TRUE(output->Write(0, mesh.positions).ok());
  ASSERT_TRUE(output->Commit().ok());
  EXPECT_TRUE(output->warnings().empty());
  MeshFile written;
  ASSERT_TRUE(ReadMeshFile(directory_.Path("out.obj"), {}, written).ok());
  EXPECT_EQ(written.faces, author_.file.faces);
  EXPECT_EQ(written.mesh.positions, mesh.positions);
  EXPECT_NE(directory_.Read("out.obj").find("usemtl red\n"), std::string::npos);
}

TEST_F(AuthorMeshTest, NormalsOfFramesAreTold) {
  ASSERT_TRUE(OpenAuthorMesh(path_, decoded_, {}, author_).ok());
  ClipOutput::Settings settings;
  settings.obj = &*author_.obj;
  std::unique_ptr<ClipOutput> output;
  ASSERT_TRUE(ClipOutput::Open(directory_.Path("f_%d.obj"), author_.file.mesh, settings, output).ok());
  ASSERT_TRUE(output->Write(0, author_.file.mesh.positions).ok());
  ASSERT_EQ(output->warnings().size(), 1U);
  EXPECT_EQ(output->warnings()[0],
            directory_.Path("f_0.obj") + ": its normals are those of the mesh it was made onto, in every frame");
}

TEST_F(AuthorMeshTest, PositionsAreRelativeToTheOffset) {
  for (Vec3f& p : decoded_.positions) p[0] -= 100;
  ASSERT_TRUE(OpenAuthorMesh(path_, decoded_, {100, 0, 0}, author_).ok());
  EXPECT_TRUE(author_.warnings.empty());
  // Without it the mesh is far off; its faces still tell all vertices but for a half turn, which the positions then
  // miss.
  ASSERT_TRUE(OpenAuthorMesh(path_, decoded_, {}, author_).ok());
  ASSERT_EQ(author_.warnings.size(), 1U);
  EXPECT_TRUE(author_.warnings[0].starts_with(path_ + ": its vertices are 100 model units from those of the first"));
}

TEST_F(AuthorMeshTest, AnotherMeshIsRefused) {
  std::swap(decoded_.triangles[0][0], decoded_.triangles[0][1]);
  EXPECT_EQ(OpenAuthorMesh(path_, decoded_, {}, author_).message(),
            path_ + ": its faces connect the vertices otherwise than those of the stream");
  decoded_.positions.push_back({});
  EXPECT_EQ(OpenAuthorMesh(path_, decoded_, {}, author_).message(), path_ + ": it has 6 vertices, the stream 7");
  EXPECT_EQ(OpenAuthorMesh(directory_.Path("none.obj"), decoded_, {}, author_).message(),
            directory_.Path("none.obj") + ": No such file or directory");
}

}  // namespace
}  // namespace sac
