// Failures: thrown with all that the library says, or returned; and what callables throw.
#include <gtest/gtest.h>
#include <beltrami/beltrami.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <type_traits>
#include <utility>
#include <vector>

#include "cpp/meshes.h"

namespace beltrami::host {
namespace {

Surface view(const Triangles& mesh) {
  return Surface(mesh.positions, mesh.faces);
}

TEST(CppError, HasStatusSentenceAndElement) {
  Triangles mesh = bent_quad();
  mesh.faces.push_back({1, 2, 99});
  try {
    Context().unwrap(view(mesh));
    FAIL() << "an index out of range was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), Status::kIndexOutOfRange);
    EXPECT_EQ(error.element_kind(), ElementKind::kFace);
    EXPECT_EQ(error.element(), 2u);
    EXPECT_NE(std::string(error.what()).find("99"), std::string::npos) << error.what();
    EXPECT_STREQ(name_of(error.status()), "BELTRAMI_E_INDEX_OUT_OF_RANGE");
    EXPECT_STREQ(error.failure().what(), error.what());
  }
}

TEST(CppError, WithoutAnElementThereIsNone) {
  const Triangles cube = triangulated_cube();
  const Result<Flattening> result = Context().try_flatten(view(cube));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.status(), Status::kClosed);
  EXPECT_EQ(result.error().element(), std::nullopt);
  EXPECT_THROW(static_cast<void>(result.value()), Error);
  EXPECT_STREQ(Failure(Status::kClosed).what(), advice_on(Status::kClosed));
}

TEST(CppError, ResultsHaveTheirValue) {
  static_assert(std::is_nothrow_copy_constructible_v<Failure>);  // for functions named try_
  Result<int> number = 3;
  EXPECT_TRUE(number.has_value());
  EXPECT_EQ(*number, 3);
  EXPECT_EQ(number.value(), 3);
  EXPECT_EQ(number.status(), Status::kOk);
  const Result<std::string> text(std::string("text"));
  EXPECT_EQ(text->size(), 4u);
  EXPECT_NO_THROW(Result<void>().value());
  EXPECT_THROW(Result<void>(Failure(Status::kEmpty)).value(), Error);
}

TEST(CppError, FlattenTakesTrianglesAlone) {
  const Polygons squares = cube();
  const Surface polygons(squares.positions, squares.corners, squares.sizes);
  EXPECT_EQ(Context().try_flatten(polygons).status(), Status::kInvalidArgument);
  const Triangles quad = bent_quad();
  const std::vector<int> labels{0, 1};
  EXPECT_EQ(Context().try_flatten(view(quad).face_labels(labels)).status(),
            Status::kInvalidArgument);
}

TEST(CppProgress, RisesAndMayBeAnyCallable) {
  const Triangles mesh = hump(20);
  Context context;
  std::vector<double> fractions;
  const auto record = [&](double fraction, const char* stage) {
    EXPECT_NE(stage, nullptr);
    fractions.push_back(fraction);
  };
  context.flatten(view(mesh), record);
  ASSERT_FALSE(fractions.empty());
  for (std::size_t i = 1; i < fractions.size(); ++i) EXPECT_GE(fractions[i], fractions[i - 1]);

  const std::size_t calls = fractions.size();
  const std::function<bool(double, const char*)> stored = [&](double fraction, const char*) {
    fractions.push_back(fraction);
    return true;
  };
  context.flatten(view(mesh), stored);
  EXPECT_GT(fractions.size(), calls);
  context.flatten(view(mesh), [last = -1.0](double fraction) mutable {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  });
  EXPECT_EQ(context.flatten(view(mesh), nullptr).status(), Status::kOk);
}

bool never(double, const char*) {
  return false;
}

TEST(CppProgress, FalseCancelsEveryCall) {
  const Triangles mesh = hump(20);
  Context context;
  EXPECT_EQ(context.try_flatten(view(mesh), never).status(), Status::kCancelled);
  EXPECT_EQ(context.try_unwrap(view(mesh), &never).status(), Status::kCancelled);
  const std::vector<Uv> flat = Context().flatten(view(mesh)).uvs();
  EXPECT_EQ(context.try_pack(UvMesh(flat, mesh.faces), [](double) { return false; }).status(),
            Status::kCancelled);
  EXPECT_THROW(context.unwrap(view(mesh), never), Error);
  EXPECT_EQ(context.flatten(view(mesh)).status(), Status::kOk);  // the context is as it was
}

struct OfTheHost {
  int number;
};

TEST(CppProgress, WhatItThrowsComesOutOfTheCall) {
  const Triangles mesh = hump(20);
  Context context;
  const auto thrower = [](double, const char*) -> bool { throw OfTheHost{42}; };
  const auto caught = [&](auto call) {
    try {
      call();
    } catch (const OfTheHost& thrown) {
      return thrown.number;
    }
    return 0;
  };
  EXPECT_EQ(caught([&] { context.flatten(view(mesh), thrower); }), 42);
  EXPECT_EQ(caught([&] { context.unwrap(view(mesh), thrower); }), 42);
  // Nothing else is thrown by what is named try_, but what is the caller's own is.
  EXPECT_EQ(caught([&] { static_cast<void>(context.try_unwrap(view(mesh), thrower)); }), 42);
  EXPECT_THROW(context.flatten(view(mesh), std::function<bool(double, const char*)>()),
               std::bad_function_call);
  EXPECT_EQ(context.flatten(view(mesh)).status(), Status::kOk);
}

TEST(CppProgress, MayDestroyTheContextThatItIsCalledBy) {
  const Triangles mesh = hump(20);
  Context context;
  const Flattening flat = context.flatten(view(mesh), [&](double) {
    context = Context();
    return true;
  });
  EXPECT_EQ(flat.uvs().size(), mesh.positions.size());
}

TEST(CppCancel, ComesFromAnotherThread) {
  const Triangles mesh = hump(60);
  Context context;
  const Canceller canceller = context.canceller();
  std::thread other;
  const Result<Atlas> result = context.try_unwrap(view(mesh), [&](double) {
    if (!other.joinable()) other = std::thread([&] { canceller.cancel(); });
    if (other.joinable()) other.join();
    other = std::thread([] {});
    return true;
  });
  if (other.joinable()) other.join();
  EXPECT_EQ(result.status(), Status::kCancelled);
  Canceller().cancel();
}

TEST(CppCancel, OrByAFlagOfTheSurface) {
  const Triangles mesh = bent_quad();
  const std::int32_t flag = 1;
  EXPECT_EQ(Context().try_unwrap(view(mesh).cancel(&flag)).status(), Status::kCancelled);
  EXPECT_EQ(Context().try_flatten(view(mesh).cancel(&flag)).status(), Status::kCancelled);
  const std::vector<Uv> uvs{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  EXPECT_EQ(Context().try_pack(UvMesh(uvs, mesh.faces).cancel(&flag)).status(), Status::kCancelled);
}

}  // namespace
}  // namespace beltrami::host
