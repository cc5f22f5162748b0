// Shows a radiosity mesh (.vtp, .vtu) coloured by one of its arrays: in a window, or as a picture
// without one.
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellData.h>
#include <vtkDataSet.h>
#include <vtkDataSetMapper.h>
#include <vtkDoubleArray.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkLookupTable.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkScalarBarActor.h>
#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>
#include <vtkWindowToImageFilter.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace {

namespace fs = std::filesystem;

/// Wrong usage or bad input: exit code 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Options {
  std::string mesh;
  std::string field;       // empty: the first that is there of kPreferred
  std::string screenshot;  // empty: a window
  int width = 1024, height = 768;
};

constexpr const char* kHelp =
    "atrium-view MESH [options]      shows a mesh with arrays (.vtp .vtu)\n"
    "  --field NAME         array to colour by, point or cell data; vectors by their luminance\n"
    "                       (default: illuminance_lux, irradiance, radiosity, or the first)\n"
    "  --screenshot FILE    writes a .png instead of opening a window (needs an X display, too:\n"
    "                       xvfb-run -a atrium-view ...)\n"
    "  --size WxH           of window or picture (1024x768)\n"
    "  --help  --version\n";

constexpr const char* kPreferred[] = {"illuminance_lux", "irradiance", "radiosity"};

std::pair<int, int> parse_size(const std::string& text) {
  int width = 0, height = 0, used = 0;
  const int n = std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used);
  if (n != 2 || static_cast<std::size_t>(used) != text.size() || width < 16 || height < 16 ||
      width > 16384 || height > 16384) {
    throw UsageError("--size " + text + ": is not WIDTHxHEIGHT, 16 to 16384 each");
  }
  return {width, height};
}

/// nullopt: help or version was printed.
std::optional<Options> parse(const std::vector<std::string>& arguments) {
  Options o;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& a = arguments[i];
    const auto value = [&]() -> const std::string& {
      if (i + 1 >= arguments.size()) throw UsageError(a + ": needs a value");
      return arguments[++i];
    };
    if (a == "--help" || a == "-h") {
      std::fputs(kHelp, stdout);
      return std::nullopt;
    }
    if (a == "--version") {
      std::puts("atrium-view " ATRIUM_VERSION);
      return std::nullopt;
    }
    if (a == "--field") {
      o.field = value();
    } else if (a == "--screenshot") {
      o.screenshot = value();
    } else if (a == "--size") {
      std::tie(o.width, o.height) = parse_size(value());
    } else if (a.starts_with("-")) {
      throw UsageError(a +
                       ": unknown option (known: --field --screenshot --size --help --version)");
    } else if (o.mesh.empty()) {
      o.mesh = a;
    } else {
      throw UsageError(a + ": one mesh at a time");
    }
  }
  if (o.mesh.empty()) throw UsageError("no mesh given (see atrium-view --help)");
  if (!o.screenshot.empty() && fs::path(o.screenshot).extension() != ".png") {
    throw UsageError(o.screenshot + ": a screenshot is a .png");
  }
  return o;
}

template <class Reader>
vtkSmartPointer<vtkDataSet> read_with(const std::string& file) {
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  vtkDataSet* data = reader->GetOutput();
  if (reader->GetErrorCode() != 0 || data->GetNumberOfCells() == 0) {
    throw UsageError(file + ": is no readable mesh, or an empty one");
  }
  return data;
}

vtkSmartPointer<vtkDataSet> read_mesh(const std::string& file) {
  if (!fs::is_regular_file(file)) throw UsageError(file + ": cannot be read: no such file");
  const std::string ending = fs::path(file).extension().string();
  if (ending == ".vtp") return read_with<vtkXMLPolyDataReader>(file);
  if (ending == ".vtu") return read_with<vtkXMLUnstructuredGridReader>(file);
  throw UsageError(file + ": unknown mesh format (known: .vtp .vtu)");
}

/// The array to show: point data where both have it, as it is smoother.
struct Field {
  vtkDataArray* array = nullptr;
  bool on_points = false;
};

Field find_field(vtkDataSet& mesh, const std::string& name) {
  if (auto* a = mesh.GetPointData()->GetArray(name.c_str())) return {a, true};
  if (auto* a = mesh.GetCellData()->GetArray(name.c_str())) return {a, false};
  return {};
}

Field choose_field(vtkDataSet& mesh, const Options& o) {
  if (!o.field.empty()) {
    if (const Field f = find_field(mesh, o.field); f.array != nullptr) return f;
    std::string known;
    for (int i = 0; i < mesh.GetCellData()->GetNumberOfArrays(); ++i) {
      known += std::string(" ") + mesh.GetCellData()->GetArrayName(i);
    }
    for (int i = 0; i < mesh.GetPointData()->GetNumberOfArrays(); ++i) {
      known += std::string(" ") + mesh.GetPointData()->GetArrayName(i);
    }
    throw UsageError("--field " + o.field + ": " + o.mesh + " has" +
                     (known.empty() ? " none" : known));
  }
  for (const char* name : kPreferred) {
    if (const Field f = find_field(mesh, name); f.array != nullptr) return f;
  }
  if (mesh.GetPointData()->GetNumberOfArrays() > 0) return {mesh.GetPointData()->GetArray(0), true};
  if (mesh.GetCellData()->GetNumberOfArrays() > 0) return {mesh.GetCellData()->GetArray(0), false};
  throw UsageError(o.mesh + ": has no arrays to show");
}

/// One number per tuple: itself, or the Rec. 709 luminance of three.
vtkSmartPointer<vtkDoubleArray> scalars_of(vtkDataArray& array) {
  auto result = vtkSmartPointer<vtkDoubleArray>::New();
  result->SetName(array.GetName());
  result->SetNumberOfTuples(array.GetNumberOfTuples());
  const bool rgb = array.GetNumberOfComponents() == 3;
  for (vtkIdType i = 0; i < array.GetNumberOfTuples(); ++i) {
    result->SetValue(i, rgb ? 0.2126 * array.GetComponent(i, 0) +
                                  0.7152 * array.GetComponent(i, 1) +
                                  0.0722 * array.GetComponent(i, 2)
                            : array.GetComponent(i, 0));
  }
  return result;
}

/// Dark blue to yellow by equal steps of hue; low values stay distinguishable.
vtkSmartPointer<vtkLookupTable> make_colours(const double range[2]) {
  auto table = vtkSmartPointer<vtkLookupTable>::New();
  table->SetNumberOfTableValues(256);
  table->SetHueRange(0.67, 0.12);
  table->SetSaturationRange(0.9, 0.8);
  table->SetValueRange(0.35, 1.0);
  table->SetTableRange(range[0], range[1] > range[0] ? range[1] : range[0] + 1.0);
  table->Build();
  return table;
}

void save_png(vtkRenderWindow& window, const std::string& file) {
  vtkNew<vtkWindowToImageFilter> grab;
  grab->SetInput(&window);
  grab->ReadFrontBufferOff();
  grab->Update();
  // Beside the target, then renamed: the picture is complete or absent.
  const std::string temporary = file + ".part.png";
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(temporary.c_str());
  writer->SetInputConnection(grab->GetOutputPort());
  writer->Write();
  std::error_code ec;
  fs::rename(temporary, file, ec);
  if (ec) throw std::runtime_error(file + ": cannot be written: " + ec.message());
}

/// From the front, the right and above, y up, everything in view.
void look_from_above(vtkRenderer& renderer) {
  vtkCamera* camera = renderer.GetActiveCamera();
  camera->SetFocalPoint(0.0, 0.0, 0.0);
  camera->SetPosition(0.5, 0.8, 1.0);
  camera->SetViewUp(0.0, 1.0, 0.0);
  renderer.ResetCamera();
}

/// VTK of Debian draws through X only and aborts the process without a display.
void require_display() {
  const char* display = std::getenv("DISPLAY");
  if (display == nullptr || *display == '\0') {
    throw std::runtime_error(
        "no display: DISPLAY is not set (for --screenshot a virtual one does: xvfb-run -a "
        "atrium-view ...)");
  }
}

void show(const Options& o) {
  const vtkSmartPointer<vtkDataSet> mesh = read_mesh(o.mesh);
  const Field field = choose_field(*mesh, o);
  if (!o.screenshot.empty()) {
    const fs::path folder = fs::absolute(o.screenshot).parent_path();
    if (!fs::is_directory(folder)) {
      throw UsageError(o.screenshot + ": cannot be written: no folder " + folder.string());
    }
  }
  require_display();

  const auto scalars = scalars_of(*field.array);
  if (field.on_points) {
    mesh->GetPointData()->SetScalars(scalars);
  } else {
    mesh->GetCellData()->SetScalars(scalars);
  }
  double range[2];
  scalars->GetRange(range);
  const auto colours = make_colours(range);

  vtkNew<vtkDataSetMapper> mapper;
  mapper->SetInputData(mesh);
  mapper->SetLookupTable(colours);
  mapper->UseLookupTableScalarRangeOn();
  field.on_points ? mapper->SetScalarModeToUsePointData() : mapper->SetScalarModeToUseCellData();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();  // colours mean numbers
  vtkNew<vtkScalarBarActor> bar;
  bar->SetLookupTable(colours);
  bar->SetTitle(field.array->GetName());
  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(0.12, 0.12, 0.12);
  renderer->AddActor(actor);
  renderer->AddViewProp(bar);

  vtkNew<vtkRenderWindow> window;
  window->SetWindowName(("atrium-view " + o.mesh).c_str());
  window->SetSize(o.width, o.height);
  window->SetOffScreenRendering(o.screenshot.empty() ? 0 : 1);
  window->AddRenderer(renderer);
  look_from_above(*renderer);
  window->Render();
  if (!o.screenshot.empty()) {
    save_png(*window, o.screenshot);
    return;
  }
  vtkNew<vtkRenderWindowInteractor> interactor;
  interactor->SetRenderWindow(window);
  vtkNew<vtkInteractorStyleTrackballCamera> style;
  interactor->SetInteractorStyle(style);
  interactor->Start();
}

int fail(int code, const char* message) {
  std::fprintf(stderr, "atrium-view: error: %s\n", message);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    vtkObject::GlobalWarningDisplayOff();
    if (const auto options = parse({argv + 1, argv + argc})) show(*options);
    return 0;
  } catch (const UsageError& e) {
    return fail(2, e.what());
  } catch (const std::exception& e) {
    return fail(1, e.what());
  }
}
