// What the programs share: the panel, the order of its edges, the clock, the line that is printed.
#pragma once
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

struct Panel {
  std::vector<std::array<double, 3>> positions;
  std::vector<std::array<std::uint32_t, 3>> faces;
  // Edges by their nodes: all in the random order; those to be flipped and split in mesh order.
  std::vector<std::array<std::uint32_t, 2>> random, flips, splits;
};

inline std::vector<std::array<std::uint32_t, 2>> read_edges(const std::string& path) {
  std::FILE* f = std::fopen(path.c_str(), "r");
  if (!f) { std::fprintf(stderr, "no %s\n", path.c_str()); std::exit(1); }
  std::vector<std::array<std::uint32_t, 2>> edges;
  std::array<std::uint32_t, 2> e;
  while (std::fscanf(f, "%u %u", &e[0], &e[1]) == 2) edges.push_back(e);
  std::fclose(f);
  return edges;
}

inline Panel read_panel(const std::string& folder) {
  Panel panel;
  std::FILE* f = std::fopen((folder + "/panel.obj").c_str(), "r");
  if (!f) { std::fprintf(stderr, "no panel in %s\n", folder.c_str()); std::exit(1); }
  char line[256];
  while (std::fgets(line, sizeof line, f)) {
    std::array<double, 3> p;
    std::array<std::uint32_t, 3> t;
    if (std::sscanf(line, "v %lf %lf %lf", &p[0], &p[1], &p[2]) == 3) panel.positions.push_back(p);
    else if (std::sscanf(line, "f %u %u %u", &t[0], &t[1], &t[2]) == 3)
      panel.faces.push_back({t[0] - 1, t[1] - 1, t[2] - 1});
  }
  std::fclose(f);
  panel.random = read_edges(folder + "/random.txt");
  panel.flips = read_edges(folder + "/flips.txt");
  panel.splits = read_edges(folder + "/splits.txt");
  return panel;
}

constexpr std::size_t SPLITS = 100000;
constexpr std::size_t COLLAPSES = 50000;

inline double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// Runs `work`, which returns how many operations were valid.
template <class Work> void timed(const char* library, const char* operation, Work work) {
  const double start = cpu_seconds();
  const std::size_t valid = work();
  const double seconds = cpu_seconds() - start;
  std::printf("%s\t%s\t%zu\t%.9f\n", library, operation, valid, seconds);
  std::fflush(stdout);
}
