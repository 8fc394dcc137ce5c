// SPDX-License-Identifier: Apache-2.0
#include "rr/array.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "rr/sequence.hpp"

namespace rr {
namespace {

TEST(Array, OfASizeIsZero) {
  const Array<double> array(3);
  EXPECT_EQ(array, (Array<double>{0, 0, 0}));
  EXPECT_TRUE(Array<double>(0).empty());
}

TEST(Array, CopiesShareTheirItems) {
  const Array<int> array{1, 2, 3};
  const Array<int> copy = array;  // NOLINT(performance-unnecessary-copy-initialization)
  EXPECT_EQ(copy.data(), array.data());
}

TEST(Array, MutateCopiesWhatOthersShare) {
  Array<int> array{1, 2, 3};
  const Array<int> copy = array;
  array.mutate()[0] = 9;
  EXPECT_EQ(copy, (Array<int>{1, 2, 3}));
  EXPECT_EQ(array, (Array<int>{9, 2, 3}));
}

TEST(Array, MutateKeepsWhatNobodyElseHas) {
  Array<int> array{1, 2, 3};
  const int* before = array.data();
  array.mutate()[0] = 9;
  EXPECT_EQ(array.data(), before);
}

TEST(Array, ViewRefersToItemsOfOthers) {
  const std::array<int, 2> items{4, 5};
  Array<int> view = Array<int>::view(items);
  EXPECT_EQ(view.data(), items.data());
  view.mutate()[0] = 9;
  EXPECT_EQ(items[0], 4);
}

TEST(Array, AssignUsesOwnMemoryAgain) {
  Array<int> array{1, 2, 3};
  const int* before = array.data();
  array.assign(std::array{7, 8});
  EXPECT_EQ(array.data(), before);
  EXPECT_EQ(array, (Array<int>{7, 8}));
}

TEST(Array, AssignLeavesSharedItemsAlone) {
  Array<int> array{1, 2, 3};
  const Array<int> copy = array;
  array.assign(std::array{7, 8, 9});
  EXPECT_EQ(copy, (Array<int>{1, 2, 3}));
}

TEST(Array, AssignDoesNotWriteOverAView) {
  std::array<int, 3> items{4, 5, 6};
  Array<int> array = Array<int>::view(items);
  array.assign(std::array{7, 8, 9});
  EXPECT_EQ(items[0], 4);
}

TEST(Array, AssignTakesAPartOfItself) {
  Array<int> array{1, 2, 3, 4};
  array.assign(std::span<const int>(array).subspan(1, 2));
  EXPECT_EQ(array, (Array<int>{2, 3}));
}

TEST(Array, AssignGivesBackMemoryThatIsMuchTooLarge) {
  Array<int> array(1000);
  const int* before = array.data();
  array.assign(std::array{1});
  EXPECT_NE(array.data(), before);
}

TEST(Array, AtChecksTheIndex) {
  const Array<int> array{1, 2};
  EXPECT_EQ(array.at(1), 2);
  EXPECT_THROW(static_cast<void>(array.at(2)), std::out_of_range);
}

TEST(Array, TakesVectorsOfBool) {
  EXPECT_EQ(Array<bool>(std::vector<bool>{true, false}), (Array<bool>{true, false}));
}

TEST(Array, RefusesSizesThatMemoryCannotHave) {
  volatile std::size_t size = std::numeric_limits<std::size_t>::max() / 4;
  EXPECT_THROW(static_cast<void>(Array<double>(size)), std::bad_alloc);
}

TEST(BoundedArray, HoldsUpToItsMaximum) {
  BoundedArray<int, 3> array{1, 2};
  array.push_back(3);
  EXPECT_EQ(array, (BoundedArray<int, 3>{1, 2, 3}));
  EXPECT_THROW(array.push_back(4), std::length_error);
  EXPECT_THROW(array.resize(4), std::length_error);
  EXPECT_THROW((BoundedArray<int, 1>{1, 2}), std::length_error);
}

TEST(BoundedArray, GrowsWithZeros) {
  BoundedArray<int, 3> array{1, 2};
  array.resize(1);
  array.resize(3);
  EXPECT_EQ(array, (BoundedArray<int, 3>{1, 0, 0}));
}

TEST(BoundedArray, ComparesItsItemsOnly) {
  BoundedArray<int, 3> a{1, 2};
  a.resize(1);
  EXPECT_EQ(a, (BoundedArray<int, 3>{1}));
}

TEST(FixedMultiArray, CountsTheFirstIndexFastest) {
  FixedMultiArray<int, 2, 3> array;
  array(1, 2) = 7;
  EXPECT_EQ(array.items, (std::array<int, 6>{0, 0, 0, 0, 0, 7}));
  array(1, 0) = 8;
  EXPECT_EQ(array.items[1], 8);
}

Sequence<Array<double>> rising() {
  co_yield Array<double>::of(1, 2);
  co_yield Array<double>::of(3.0, 4, 5.5F);
}

TEST(Array, OfItemsCanBeYielded) {
  const std::shared_ptr<GeneratorSource> sequence = rising().source();
  Array<double> result;
  ASSERT_TRUE(sequence->rr_step(nullptr, &result));
  EXPECT_EQ(result, (Array<double>{1, 2}));
  ASSERT_TRUE(sequence->rr_step(nullptr, &result));
  EXPECT_EQ(result, (Array<double>{3, 4, 5.5}));
  EXPECT_FALSE(sequence->rr_step(nullptr, &result));
}

}  // namespace
}  // namespace rr
