// OpenMesh 9, triangle kernel of arrays, double precision.
#include "common.h"
#include <OpenMesh/Core/Mesh/DefaultTriMesh.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

using Mesh = OpenMesh::TriMesh_ArrayKernelT<OpenMesh::DefaultTraitsDouble>;
using Edges = std::vector<OpenMesh::EdgeHandle>;

static Mesh build(const Panel& panel) {
  Mesh mesh;
  mesh.reserve(panel.positions.size(), panel.random.size(), panel.faces.size());
  for (const auto& p : panel.positions) mesh.add_vertex({p[0], p[1], p[2]});
  for (const auto& f : panel.faces)
    mesh.add_face(OpenMesh::VertexHandle(f[0]), OpenMesh::VertexHandle(f[1]), OpenMesh::VertexHandle(f[2]));
  return mesh;
}

static std::size_t flip(Mesh& mesh, const Edges& edges) {
  std::size_t valid = 0;
  for (auto e : edges)
    if (mesh.is_flip_ok(e)) { mesh.flip(e); ++valid; }
  return valid;
}

static std::size_t split(Mesh& mesh, const Edges& edges) {
  for (std::size_t i = 0; i < SPLITS; ++i) {
    const auto h = mesh.halfedge_handle(edges[i], 0);
    const auto middle = (mesh.point(mesh.from_vertex_handle(h)) + mesh.point(mesh.to_vertex_handle(h))) * 0.5;
    mesh.split(edges[i], middle);
  }
  return SPLITS;
}

static std::size_t collapse(Mesh& mesh, const Edges& edges) {
  std::size_t valid = 0;
  for (auto e : edges) {
    if (valid == COLLAPSES) break;
    if (mesh.status(e).deleted()) continue;
    const auto h = mesh.halfedge_handle(e, 0);
    if (mesh.is_collapse_ok(h)) { mesh.collapse(h); ++valid; }
  }
  return valid;
}

int main(int, char** argv) {
  const Panel panel = read_panel(argv[1]);
  timed("openmesh", "build", [&] { return build(panel).n_faces(); });
  const Mesh mesh = build(panel);
  const auto own = [&](const auto& list) {
    Edges edges;
    for (const auto& e : list)
      edges.push_back(mesh.edge_handle(mesh.find_halfedge(OpenMesh::VertexHandle(e[0]), OpenMesh::VertexHandle(e[1]))));
    return edges;
  };
  const Edges random = own(panel.random), flips = own(panel.flips), splits = own(panel.splits);
  { Mesh m = mesh; timed("openmesh", "flip, random", [&] { return flip(m, random); }); }
  { Mesh m = mesh; timed("openmesh", "flip, mesh order", [&] { return flip(m, flips); }); }
  { Mesh m = mesh; timed("openmesh", "split, random", [&] { return split(m, random); }); }
  { Mesh m = mesh; timed("openmesh", "split, mesh order", [&] { return split(m, splits); }); }
  {
    Mesh m = mesh;
    m.request_vertex_status();
    m.request_edge_status();
    m.request_halfedge_status();
    m.request_face_status();
    timed("openmesh", "collapse, random", [&] { return collapse(m, random); });
  }
}
