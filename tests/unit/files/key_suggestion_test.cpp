#include "files/key_suggestion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace edgeslam {
namespace {

const std::vector<std::string> known{"edges.sigma", "edges.sigma_ratio", "points.spacing", "pose.huber"};

TEST(ClosestKey, SeesThroughSlips) {
  EXPECT_EQ(closestKey("edges.sigam", known), "edges.sigma");
  EXPECT_EQ(closestKey("edges.sgma", known), "edges.sigma");
  EXPECT_EQ(closestKey("edge.sigma", known), "edges.sigma");
  EXPECT_EQ(closestKey("edges.sigmaratio", known), "edges.sigma_ratio");
  EXPECT_EQ(closestKey("points.spaceing", known), "points.spacing");
}

TEST(ClosestKey, FindsTheNameInAnotherSection) { EXPECT_EQ(closestKey("tracking.huber", known), "pose.huber"); }

TEST(ClosestKey, SaysNothingWhereNothingIsNear) {
  EXPECT_EQ(closestKey("camera.exposure", known), "");
  EXPECT_EQ(closestKey("", known), "");
  EXPECT_EQ(closestKey(std::string(1000000, 'e'), known), "");
  EXPECT_EQ(closestKey("edges.sigma", {}), "");
}

// By its definition, from the ends of both.
int plainDistance(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return static_cast<int>(a.size() + b.size());
  const std::string a1 = a.substr(0, a.size() - 1), b1 = b.substr(0, b.size() - 1);
  int distance = std::min(
      {plainDistance(a1, b1) + (a.back() == b.back() ? 0 : 1), plainDistance(a1, b) + 1, plainDistance(a, b1) + 1});
  const bool is_swapped = !a1.empty() && !b1.empty() && a.back() == b1.back() && b.back() == a1.back();
  if (is_swapped) {
    distance = std::min(distance, plainDistance(a1.substr(0, a1.size() - 1), b1.substr(0, b1.size() - 1)) + 1);
  }
  return distance;
}

TEST(ClosestKey, IsTheOneOfTheFewestEdits) {
  std::mt19937 random(1);
  const auto word = [&] {
    std::string letters(1 + random() % 5, 'a');
    for (char& letter : letters) letter = static_cast<char>('a' + random() % 3);
    return letters;
  };
  int found = 0;
  for (int i = 0; i < 300; ++i) {
    const std::string wrong = word();
    std::vector<std::string> words;
    while (words.size() < 4) {
      words.push_back(word());
      if (words.back() == wrong) words.pop_back();
    }
    std::vector<int> distances;
    for (const std::string& known_word : words) distances.push_back(plainDistance(wrong, known_word));
    const auto nearest = std::min_element(distances.begin(), distances.end());
    const int most_edits = wrong.size() <= 3 ? 1 : 2;
    const std::string expected =
        *nearest <= most_edits ? words[static_cast<std::size_t>(nearest - distances.begin())] : "";
    EXPECT_EQ(closestKey(wrong, words), expected) << wrong;
    found += expected.empty() ? 0 : 1;
  }
  EXPECT_GT(found, 50);
  EXPECT_LT(found, 290);
}

}  // namespace
}  // namespace edgeslam
