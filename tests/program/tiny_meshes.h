// The smallest meshes that show each behaviour, as OBJ text.
#pragma once

#include <cmath>
#include <cstdio>
#include <string>

namespace beltrami::cli {

/// A bent square of two triangles.
inline const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0.25\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";

/// The same with injective UVs.
inline const std::string kSquareWithUvs =
    "v 0 0 0\nv 1 0 0\nv 1 1 0.25\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

/// The second triangle is flipped over the diagonal.
inline const std::string kSquareWithFlip =
    "v 0 0 0\nv 1 0 0\nv 1 1 0.25\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 1 0.5\n"
    "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

inline const std::string kTetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

/// A fan around the origin that turns by more than a whole circle: its UVs overlap without a flip.
inline std::string fan_beyond_a_circle() {
  std::string text = "v 0 0 0\n", uvs = "vt 0 0\n", faces;
  for (int i = 0; i <= 8; ++i) {
    char line[96];
    const double angle = i * 0.9;  // 7.2 in all, more than 2 pi
    std::snprintf(line, sizeof line, "v %g %g %g\n", std::cos(angle), std::sin(angle), 0.1 * i);
    text += line;
    std::snprintf(line, sizeof line, "vt %g %g\n", std::cos(angle), std::sin(angle));
    uvs += line;
  }
  for (int i = 2; i <= 9; ++i) {
    faces += "f 1/1 " + std::to_string(i) + "/" + std::to_string(i) + " " + std::to_string(i + 1) +
             "/" + std::to_string(i + 1) + "\n";
  }
  return text + uvs + faces;
}

/// A bumpy grid of n x n squares.
inline std::string grid(int n) {
  std::string text;
  char line[128];
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) {
      std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", i / 7.0, j / 7.0,
                    std::sin(0.9 * i) * std::cos(1.1 * j) / 7);
      text += line;
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i + 1, b = a + 1, c = b + n + 1, d = a + n + 1;
      std::snprintf(line, sizeof line, "f %d %d %d\nf %d %d %d\n", a, b, c, a, c, d);
      text += line;
    }
  }
  return text;
}

/// A torus of n x n squares with one triangle taken out: one boundary, and a handle.
inline std::string torus_with_hole(int n) {
  std::string text;
  char line[128];
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const double u = 2 * 3.14159265358979 * i / n, v = 2 * 3.14159265358979 * j / n;
      std::snprintf(line, sizeof line, "v %g %g %g\n", (2 + std::cos(v)) * std::cos(u),
                    (2 + std::cos(v)) * std::sin(u), std::sin(v));
      text += line;
    }
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = j * n + i + 1, b = j * n + (i + 1) % n + 1;
      const int c = (j + 1) % n * n + (i + 1) % n + 1, d = (j + 1) % n * n + i + 1;
      std::snprintf(line, sizeof line, "f %d %d %d\n", a, b, c);
      text += line;
      if (i + j == 0) continue;
      std::snprintf(line, sizeof line, "f %d %d %d\n", a, c, d);
      text += line;
    }
  }
  return text;
}

}  // namespace beltrami::cli
