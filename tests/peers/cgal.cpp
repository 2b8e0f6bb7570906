// CGAL 5.5 Surface_mesh, double precision.
#include "common.h"
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/boost/graph/Euler_operations.h>

using Point = CGAL::Simple_cartesian<double>::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
using Edges = std::vector<Mesh::Edge_index>;

static Mesh build(const Panel& panel) {
  Mesh mesh;
  mesh.reserve(panel.positions.size(), panel.random.size(), panel.faces.size());
  for (const auto& p : panel.positions) mesh.add_vertex(Point(p[0], p[1], p[2]));
  for (const auto& f : panel.faces)
    mesh.add_face(Mesh::Vertex_index(f[0]), Mesh::Vertex_index(f[1]), Mesh::Vertex_index(f[2]));
  return mesh;
}

static std::size_t flip(Mesh& mesh, const Edges& edges) {
  std::size_t valid = 0;
  for (auto e : edges) {
    const auto h = mesh.halfedge(e);
    const auto o = mesh.opposite(h);
    if (mesh.is_border(h) || mesh.is_border(o)) continue;
    // No such edge yet.
    if (mesh.halfedge(mesh.target(mesh.next(h)), mesh.target(mesh.next(o))) != Mesh::null_halfedge()) continue;
    CGAL::Euler::flip_edge(h, mesh);
    ++valid;
  }
  return valid;
}

static std::size_t split(Mesh& mesh, const Edges& edges) {
  for (std::size_t i = 0; i < SPLITS; ++i) {
    const auto h = mesh.halfedge(edges[i]);
    const auto middle = CGAL::midpoint(mesh.point(mesh.source(h)), mesh.point(mesh.target(h)));
    const auto made = CGAL::Euler::split_edge(h, mesh);
    mesh.point(mesh.target(made)) = middle;
    if (!mesh.is_border(made)) CGAL::Euler::split_face(made, mesh.next(h), mesh);
    const auto o = mesh.opposite(h);
    if (!mesh.is_border(o)) CGAL::Euler::split_face(o, mesh.next(mesh.opposite(made)), mesh);
  }
  return SPLITS;
}

static std::size_t collapse(Mesh& mesh, const Edges& edges) {
  std::size_t valid = 0;
  for (auto e : edges) {
    if (valid == COLLAPSES) break;
    if (mesh.is_removed(e)) continue;
    if (CGAL::Euler::does_satisfy_link_condition(e, mesh)) { CGAL::Euler::collapse_edge(e, mesh); ++valid; }
  }
  return valid;
}

int main(int, char** argv) {
  const Panel panel = read_panel(argv[1]);
  timed("cgal", "build", [&] { return std::size_t(build(panel).number_of_faces()); });
  const Mesh mesh = build(panel);
  const auto own = [&](const auto& list) {
    Edges edges;
    for (const auto& e : list)
      edges.push_back(mesh.edge(mesh.halfedge(Mesh::Vertex_index(e[0]), Mesh::Vertex_index(e[1]))));
    return edges;
  };
  const Edges random = own(panel.random), flips = own(panel.flips), splits = own(panel.splits);
  { Mesh m = mesh; timed("cgal", "flip, random", [&] { return flip(m, random); }); }
  { Mesh m = mesh; timed("cgal", "flip, mesh order", [&] { return flip(m, flips); }); }
  { Mesh m = mesh; timed("cgal", "split, random", [&] { return split(m, random); }); }
  { Mesh m = mesh; timed("cgal", "split, mesh order", [&] { return split(m, splits); }); }
  { Mesh m = mesh; timed("cgal", "collapse, random", [&] { return collapse(m, random); }); }
}
