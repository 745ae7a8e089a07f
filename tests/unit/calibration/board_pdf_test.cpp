#include "calibration/board_pdf.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <regex>

#include "calibration/board_detection.h"
#include "calibration/board_drawing.h"
#include "unit/calibration/rendered_board.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

struct PageRectangle {
  double left_mm, bottom_mm, width_mm, height_mm;
};

std::vector<PageRectangle> rectanglesOf(const std::string& pdf) {
  const std::regex rectangle(R"(([-.0-9]+) ([-.0-9]+) ([-.0-9]+) ([-.0-9]+) re\n)");
  std::vector<PageRectangle> found;
  for (std::sregex_iterator i(pdf.begin(), pdf.end(), rectangle), end; i != end; ++i) {
    const auto mm = [&](std::size_t group) { return std::stod((*i)[group]) * 25.4 / 72; };
    found.push_back({mm(1), mm(2), mm(3), mm(4)});
  }
  return found;
}

Eigen::Vector2d pageSize_mm(const std::string& pdf) {
  std::smatch match;
  std::regex_search(pdf, match, std::regex(R"(/MediaBox \[0 0 ([.0-9]+) ([.0-9]+)\])"));
  return Eigen::Vector2d(std::stod(match[1]), std::stod(match[2])) * 25.4 / 72;
}

TEST(BoardPdf, HasTheBoardAtTrueScaleAndARulerOf100Millimetres) {
  for (const char* text : {"chessboard:9x6:25mm", "charuco:8x6:29mm:21mm", "aprilgrid:6x5:26mm:0.3"}) {
    const Board board = parseBoard(text);
    const std::string pdf = boardPdf(board, paperOfName("a4"));
    EXPECT_NEAR(pageSize_mm(pdf).minCoeff(), 210, 0.01);
    EXPECT_NEAR(pageSize_mm(pdf).maxCoeff(), 297, 0.01);
    EXPECT_NE(pdf.find(text), std::string::npos) << "the board is named on the page";
    const BoardDrawing drawing = drawBoard(board);
    const std::vector<PageRectangle> page = rectanglesOf(pdf);
    ASSERT_GT(page.size(), drawing.black.size());
    for (std::size_t i = 0; i < drawing.black.size(); ++i) {
      const BoardRectangle& r = drawing.black[i];
      EXPECT_NEAR(page[i].width_mm, 1e3 * (r.right_m - r.left_m), 1e-3);
      EXPECT_NEAR(page[i].height_mm, 1e3 * (r.bottom_m - r.top_m), 1e-3);
      EXPECT_NEAR(page[i].left_mm - page[0].left_mm, 1e3 * (r.left_m - drawing.black[0].left_m), 1e-3);
      EXPECT_NEAR(page[i].bottom_mm - page[0].bottom_mm, -1e3 * (r.bottom_m - drawing.black[0].bottom_m), 1e-3);
      EXPECT_GE(page[i].left_mm, 7.9);
    }
    EXPECT_NEAR(page[drawing.black.size()].width_mm, 100, 1e-3);
  }
}

TEST(BoardPdf, ItsTableOfObjectsIsRight) {
  const std::string pdf = boardPdf(parseBoard("chessboard:9x6:25mm"), paperOfName("A4"));
  const std::size_t table = std::stoul(pdf.substr(pdf.rfind("startxref\n") + 10));
  ASSERT_EQ(pdf.compare(table, 9, "xref\n0 6\n"), 0);
  for (std::size_t i = 1; i <= 5; ++i) {
    const std::size_t offset = std::stoul(pdf.substr(table + 9 + 20 * i, 10));
    EXPECT_EQ(pdf.compare(offset, 7, std::to_string(i) + " 0 obj"), 0);
  }
}

TEST(BoardPdf, WhatDoesNotFitIsToldWithWhatWould) {
  expectInputError([] { boardPdf(parseBoard("chessboard:9x6:30mm"), paperOfName("A4")); }, "does not fit A4",
                   "300 x 210 mm", "it would fit A3", "25mm at most");
  expectInputError([] { boardPdf(parseBoard("aprilgrid:6x6:1m:0.3"), paperOfName("A0")); }, "does not fit A0");
  EXPECT_NO_THROW(boardPdf(parseBoard("chessboard:9x6:25mm"), paperOfName("A4")));
  EXPECT_THROW(boardPdf(parseBoard("chessboard:9x6:25.5mm"), paperOfName("A4")), InputError);
  expectInputError([] { paperOfName("A9"); }, "A9", "letter");
  EXPECT_EQ(paperOfName("600x400").height_mm, 600);
}

// As a printer sees it, by a program of others.
TEST(BoardPdf, IsFoundWholeInTheRasteredPage) {
  if (std::system("command -v pdftoppm >/dev/null 2>&1") != 0) GTEST_SKIP() << "no pdftoppm (Debian: poppler-utils)";
  constexpr double dots_per_millimetre = 75 / 25.4;
  for (const char* text : {"chessboard:9x6:25mm", "charuco:8x6:29mm:21mm", "aprilgrid:6x5:26mm:0.3"}) {
    const TemporaryFolder folder;
    const Board board = parseBoard(text);
    const std::string pdf = boardPdf(board, paperOfName("A4"));
    const std::string path = folder.write("board.pdf", pdf), image = folder.path("page");
    ASSERT_EQ(std::system(("pdftoppm -r 75 -gray -singlefile " + path + " " + image).c_str()), 0);
    const cv::Mat grey = cv::imread(image + ".pgm", cv::IMREAD_GRAYSCALE);
    ASSERT_FALSE(grey.empty());
    const std::optional<BoardSighting> seen = detectBoard(grey, board);
    ASSERT_TRUE(seen) << text;
    const std::vector<Eigen::Vector2d> places = boardCorners(board);
    EXPECT_GE(seen->corners.size(), 9 * places.size() / 10) << text;
    const PageRectangle first = rectanglesOf(pdf)[0];
    const BoardRectangle drawn = drawBoard(board).black[0];
    const double page_mm = pageSize_mm(pdf).y();
    const auto onPage = [&](const Eigen::Vector2d& place) {
      const double x_mm = first.left_mm + 1e3 * (place.x() - drawn.left_m);
      const double y_mm = page_mm - first.bottom_mm + 1e3 * (place.y() - drawn.bottom_m);
      return Eigen::Vector2d(x_mm * dots_per_millimetre - 0.5, y_mm * dots_per_millimetre - 0.5);
    };
    for (const BoardCorner& corner : numberedFrom(seen->corners, board, onPage(places[0]))) {
      const Eigen::Vector2d expected = onPage(places[static_cast<std::size_t>(corner.number)]);
      EXPECT_LT((corner.pixel - expected).norm(), 1) << text << " corner " << corner.number;
    }
  }
}

}  // namespace
}  // namespace edgeslam
