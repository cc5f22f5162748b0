#pragma once

#include <vtkObjectFactory.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

namespace atrium::view {

/// Does an array of texts hold no more than it announces? VTK's readers write the ones that are too
/// many behind its end. To be asked while the parser has the file.
[[nodiscard]] inline bool holds_no_more_texts(vtkXMLDataElement* array, vtkXMLDataParser* parser) {
  std::int64_t tuples = 0, components = 1, offset = 0;
  array->GetScalarAttribute("NumberOfTuples", tuples);
  array->GetScalarAttribute("NumberOfComponents", components);
  const bool appended =
      array->GetAttribute("offset") != nullptr && array->GetScalarAttribute("offset", offset) != 0;
  const char* format = array->GetAttribute("format");
  const bool text = format == nullptr || std::strcmp(format, "binary") != 0;
  std::array<char, 4096> buffer;
  std::uint64_t at = 0;
  std::int64_t ends = 0;  // a text ends with 0
  for (std::size_t read = buffer.size(); read == buffer.size(); at += read) {
    read = appended
               ? parser->ReadAppendedData(offset, buffer.data(), at, buffer.size(), VTK_CHAR)
               : parser->ReadInlineData(array, text, buffer.data(), at, buffer.size(), VTK_CHAR);
    ends += std::count(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(read), '\0');
    if (ends > tuples * components) return false;
  }
  return true;
}

/// One of VTK's XML readers that fails for texts of another number than announced.
template <class Reader>
class CheckedReader : public Reader {
 public:
  static CheckedReader* New() { VTK_STANDARD_NEW_BODY(CheckedReader); }

 protected:
  int ReadPrimaryElement(vtkXMLDataElement* primary) override {
    if (Reader::ReadPrimaryElement(primary) == 0) return 0;
    for (int i = 0; i < primary->GetNumberOfNestedElements(); ++i) {
      vtkXMLDataElement* fields = primary->GetNestedElement(i);
      if (std::strcmp(fields->GetName(), "FieldData") != 0) continue;
      for (int k = 0; k < fields->GetNumberOfNestedElements(); ++k) {
        vtkXMLDataElement* array = fields->GetNestedElement(k);
        const char* type = array->GetAttribute("type");
        if (type == nullptr || std::strcmp(type, "String") != 0) continue;
        if (holds_no_more_texts(array, this->XMLParser)) continue;
        vtkErrorMacro("an array of texts holds more than it announces");
        return 0;
      }
    }
    return 1;
  }
};

}  // namespace atrium::view
