#include "calibration/board_pdf.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "calibration/board_drawing.h"
#include "edgeslam/input_error.h"
#include "files/format_text.h"
#include "files/text_file.h"

namespace edgeslam {
namespace {

constexpr double margin_mm = 8;  // that printers leave white
constexpr double ruler_mm = 16;  // height of the strip with ruler and text, gap to the board included

const std::array<Paper, 9>& papers() {
  static const std::array<Paper, 9> list{{{"A5", 148, 210},
                                          {"A4", 210, 297},
                                          {"A3", 297, 420},
                                          {"A2", 420, 594},
                                          {"A1", 594, 841},
                                          {"A0", 841, 1189},
                                          {"letter", 215.9, 279.4},
                                          {"legal", 215.9, 355.6},
                                          {"tabloid", 279.4, 431.8}}};
  return list;
}

std::string number(double value) { return formatted("%.4f", value); }

std::string millimetres(double value) { return formatted("%.4g", value); }

std::string lowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

// What is drawn on the page, in millimetres from its top left.
class Page {
 public:
  Page(double width_mm, double height_mm) : width_mm_(width_mm), height_mm_(height_mm) {}

  // One path for all: viewers then leave no seams between rectangles that touch.
  void addRectangle(double left, double top, double right, double bottom) {
    path_ +=
        x(left) + " " + y(bottom) + " " + number(points(right - left)) + " " + number(points(bottom - top)) + " re\n";
  }
  void addText(double left, double baseline, double size_mm, const std::string& text) {
    std::string escaped;
    for (const char c : text) escaped += c == '(' || c == ')' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    texts_ +=
        "BT /F1 " + number(points(size_mm)) + " Tf " + x(left) + " " + y(baseline) + " Td (" + escaped + ") Tj ET\n";
  }

  std::string pdf() const {
    const std::string content = "0 g\n" + path_ + "f\n" + texts_;
    const std::vector<std::string> objects{
        "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
        "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + number(points(width_mm_)) + " " + number(points(height_mm_)) +
            "] /Contents 4 0 R /Resources << /Font << /F1 5 0 R >> >> >>",
        "<< /Length " + std::to_string(content.size()) + " >>\nstream\n" + content + "endstream",
        "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>"};
    std::string file = "%PDF-1.6\n";
    std::string table = "xref\n0 " + std::to_string(objects.size() + 1) + "\n0000000000 65535 f \n";
    for (std::size_t i = 0; i < objects.size(); ++i) {
      table += formatted("%010zu 00000 n \n", file.size());
      file += std::to_string(i + 1) + " 0 obj\n" + objects[i] + "\nendobj\n";
    }
    return file + table + "trailer\n<< /Size " + std::to_string(objects.size() + 1) + " /Root 1 0 R >>\nstartxref\n" +
           std::to_string(file.size()) + "\n%%EOF\n";
  }

 private:
  static double points(double mm) { return mm * 72 / 25.4; }
  static std::string x(double mm) { return number(points(mm)); }
  std::string y(double mm) const { return number(points(height_mm_ - mm)); }

  double width_mm_, height_mm_;
  std::string path_, texts_;
};

void addRuler(Page& page, double left, double top) {
  constexpr double line_mm = 0.2;
  page.addRectangle(left, top, left + 100, top + line_mm);
  for (int mm = 0; mm <= 100; mm += 5) {
    const double middle = std::clamp(left + mm, left + line_mm / 2, left + 100 - line_mm / 2);
    page.addRectangle(middle - line_mm / 2, top + line_mm, middle + line_mm / 2, top + (mm % 10 == 0 ? 4 : 2.5));
  }
}

struct PageSize {
  double width_mm, height_mm;
};

// The side of the square, of whole or half millimetres, with which the board would fit; 0 where none does.
double fittingSquare_mm(const BoardRectangle& extent, double square_m, const PageSize& page) {
  const double width = extent.right_m - extent.left_m, height = extent.bottom_m - extent.top_m;
  const double factor = std::min((page.width_mm - 2 * margin_mm) * 1e-3 / width,
                                 (page.height_mm - 2 * margin_mm - ruler_mm) * 1e-3 / height);
  return factor > 0 ? std::floor(2e3 * square_m * factor + 1e-9) / 2 : 0;
}

bool fits(const BoardRectangle& extent, const PageSize& page) {
  const double width = 1e3 * (extent.right_m - extent.left_m), height = 1e3 * (extent.bottom_m - extent.top_m);
  return width <= page.width_mm - 2 * margin_mm + 1e-6 && height <= page.height_mm - 2 * margin_mm - ruler_mm + 1e-6;
}

[[noreturn]] void refuse(const Board& board, const BoardRectangle& extent, const Paper& paper, double fitting_mm) {
  const double width = 1e3 * (extent.right_m - extent.left_m), height = 1e3 * (extent.bottom_m - extent.top_m);
  std::string message = "the board " + boardText(board) + " does not fit " + paper.name + ": it is " +
                        millimetres(width) + " x " + millimetres(height) + " mm, and " + millimetres(margin_mm) +
                        " mm of margin and the ruler are added";
  for (const Paper& other : papers()) {
    if (!fits(extent, {other.width_mm, other.height_mm}) && !fits(extent, {other.height_mm, other.width_mm})) continue;
    message += "; it would fit " + other.name;
    break;
  }
  if (fitting_mm >= 1) {
    message += std::string("; on ") + paper.name + " its " + (board.kind == BoardKind::aprilgrid ? "tags" : "squares") +
               " can be " + millimetres(fitting_mm) + "mm at most";
  }
  throw InputError(message);
}

}  // namespace

Paper paperOfName(const std::string& name) {
  for (const Paper& paper : papers()) {
    if (lowerCase(paper.name) == lowerCase(name)) return paper;
  }
  const std::size_t cross = name.find('x');
  const std::optional<double> width = parseNumber(name.substr(0, cross));
  const std::optional<double> height = cross == std::string::npos ? std::nullopt : parseNumber(name.substr(cross + 1));
  if (width && height && std::min(*width, *height) >= 50 && std::max(*width, *height) <= 5000) {
    return {name + " mm", std::min(*width, *height), std::max(*width, *height)};
  }
  throw InputError("no paper is called '" + name +
                   "'; expected A0 to A5, letter, legal, tabloid, or WIDTHxHEIGHT [mm], 50 to 5000");
}

std::string boardPdf(const Board& board, const Paper& paper) {
  const BoardDrawing drawing = drawBoard(board);
  const BoardRectangle& extent = drawing.extent;
  const PageSize upright{paper.width_mm, paper.height_mm}, turned{paper.height_mm, paper.width_mm};
  const double upright_fits_mm = fittingSquare_mm(extent, board.square_m, upright);
  const double turned_fits_mm = fittingSquare_mm(extent, board.square_m, turned);
  const PageSize size = upright_fits_mm >= turned_fits_mm ? upright : turned;
  const double width = 1e3 * (extent.right_m - extent.left_m), height = 1e3 * (extent.bottom_m - extent.top_m);
  const double free_height = size.height_mm - 2 * margin_mm - ruler_mm;
  if (!fits(extent, size)) {
    refuse(board, extent, paper, std::max(upright_fits_mm, turned_fits_mm));
  }

  Page page(size.width_mm, size.height_mm);
  const double left = (size.width_mm - width) / 2 - 1e3 * extent.left_m;
  const double top = margin_mm + (free_height - height) / 2 - 1e3 * extent.top_m;
  for (const BoardRectangle& r : drawing.black) {
    page.addRectangle(left + 1e3 * r.left_m, top + 1e3 * r.top_m, left + 1e3 * r.right_m, top + 1e3 * r.bottom_m);
  }
  const double strip = size.height_mm - margin_mm - 10;
  addRuler(page, margin_mm, strip);
  page.addText(margin_mm, strip + 7.5, 2.8,
               "This line must be 100 mm long. Print at 100 %, without fitting to the page.");
  page.addText(margin_mm, strip + 11, 2.8, "edgeslam calibrate --board " + boardText(board) + " ...");
  return page.pdf();
}

}  // namespace edgeslam
