#include "plot/font.h"

#include <vtkTextProperty.h>

#include <filesystem>
#include <string>
#include <system_error>

namespace atrium::plot {
namespace {

std::string find_font(const char* file_name) {
  for (const char* folder : {
           "/usr/share/fonts/truetype/dejavu",    // Debian, Ubuntu
           "/usr/share/fonts/dejavu-sans-fonts",  // Fedora
           "/usr/share/fonts/TTF",                // Arch
           "/usr/share/fonts/truetype",
           "/usr/share/fonts/dejavu",  // openSUSE and others
           "/usr/local/share/fonts",
       }) {
    std::error_code ec;
    const std::filesystem::path file = std::filesystem::path(folder) / file_name;
    if (std::filesystem::is_regular_file(file, ec)) return file.string();
  }
  return {};
}

}  // namespace

void set_font(vtkTextProperty* style, bool bold) {
  static const std::string regular_file = find_font("DejaVuSans.ttf");
  static const std::string bold_file = find_font("DejaVuSans-Bold.ttf");
  style->SetBold(bold ? 1 : 0);
  style->SetItalic(0);
  const std::string& file = bold ? bold_file : regular_file;
  if (file.empty()) {
    style->SetFontFamilyToArial();
    return;
  }
  style->SetFontFile(file.c_str());
  style->SetFontFamily(VTK_FONT_FILE);
}

}  // namespace atrium::plot
