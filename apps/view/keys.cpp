#include "keys.h"

#include <cstdio>

namespace atrium::view {
namespace {

constexpr Key kKeys[] = {
    {Action::Help, "question", "?", "this list"},
    {Action::NextField, "f", "f", "next field"},
    {Action::PreviousField, "F", "F", "previous field"},
    {Action::NextSide, "b", "b", "side: the one that is seen, front, back"},
    {Action::Logarithmic, "l", "l", "logarithmic or linear range"},
    {Action::AutomaticRange, "a", "a", "range and exposure for this view"},
    {Action::RangeUp, "bracketright", "]", "range up to more"},
    {Action::RangeDown, "bracketleft", "[", "range up to less"},
    {Action::MoreExposure, "plus", "+", "brighter"},
    {Action::LessExposure, "minus", "-", "darker"},
    {Action::Contours, "i", "i", "contours"},
    {Action::MoreContours, "period", ".", "more contours"},
    {Action::FewerContours, "comma", ",", "fewer contours"},
    {Action::Flat, "m", "m", "one value per element, or smooth"},
    {Action::Edges, "e", "e", "edges of elements"},
    {Action::Cull, "c", "c", "hide faces that are turned away"},
    {Action::Ceilings, "x", "x", "hide ceilings"},
    {Action::Clip, "k", "k", "cut horizontally under the cursor, or no cut"},
    {Action::ClipUp, "Prior", "PgUp", "move the cut up (walking: move up)"},
    {Action::ClipDown, "Next", "PgDn", "move the cut down (walking: move down)"},
    {Action::SelectObject, "p", "p", "select the object under the cursor"},
    {Action::SelectFacet, "P", "P", "select the flat surface under the cursor"},
    {Action::SelectNothing, "u", "u", "select nothing"},
    {Action::Statistics, "h", "h", "histogram and statistics of the selection"},
    {Action::Sliders, "g", "g", "sliders of light groups"},
    {Action::NextCamera, "v", "v", "next camera"},
    {Action::ResetCamera, "r", "r", "back to the camera"},
    {Action::Walk, "w", "w", "walk (arrows, mouse turns the head), or orbit"},
    {Action::Legend, "n", "n", "legend"},
    {Action::Screenshot, "s", "s", "write a picture, atrium-view-N.png"},
    {Action::Quit, "q", "q", "quit"}};

constexpr const char* kMouse[][2] = {{"left", "orbit; walking: turn the head"},
                                     {"middle", "move the picture (also Shift and left)"},
                                     {"right, wheel", "nearer, farther"}};

std::string line(const char* key, const char* text) {
  char buffer[128];
  std::snprintf(buffer, sizeof buffer, "%-13s %s\n", key, text);
  return buffer;
}

}  // namespace

std::span<const Key> keys() { return kKeys; }

const Key* find_key(const std::string& symbol) {
  for (const Key& k : kKeys)
    if (symbol == k.symbol) return &k;
  return nullptr;
}

std::string key_help() {
  std::string text;
  for (const Key& k : kKeys) text += line(k.shown, k.text);
  for (const auto& m : kMouse) text += line(m[0], m[1]);
  return text;
}

}  // namespace atrium::view
