// What goes wrong round the program: full disks, closed pipes, signals at any moment, files that
// change, little memory. Files are complete or absent, errors are one line, nothing crashes.
#include <sys/mount.h>

#include <cstdio>
#include <sstream>

#include <gtest/gtest.h>

#include "scene/image_io.h"
#include "support/run_program.h"

namespace {

using atrium::test::expect_error;
using atrium::test::read_file;
using atrium::test::Result;
using atrium::test::run;
using atrium::test::run_command;
using atrium::test::TempFolder;

// A closed box with a lamp: light goes round, so there is something to solve.
constexpr const char* kRoom =
    "atrium: 1\nunit: nit\nmaterials:\n  wall: {body: 0.7}\n  lamp: {body: 0.5, emission: 100}\n"
    "objects:\n"
    "  - {name: room, material: wall, box: {min: [0, 0, 0], max: [3, 2.5, 4], inside: true}}\n"
    "  - {name: lamp, material: lamp, polygon: [[1, 2.4, 1], [2, 2.4, 1], [2, 2.4, 2], [1, 2.4, "
    "2]]}\n"
    "cameras:\n"
    "  - {name: inside, perspective: {eye: [1.5, 1.2, 3.8], target: [1.5, 1, 0], yfov: 60}}\n";

class Faults : public ::testing::Test {
 protected:
  Faults() { folder.write("room.yaml", kRoom); }

  /// Names of the files that are there, hidden ones too.
  [[nodiscard]] std::string files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    std::string all;
    for (const std::string& name : names) all += name + " ";
    return all;
  }
  Result with(const std::string& before, const std::string& arguments) const {
    return run_command(folder, before + std::string(ATRIUM_PROGRAM) + " " + arguments);
  }
  TempFolder folder;
};

constexpr const char* kSmallPicture =
    " --size 64x64 --samples 1 --method direct --spectrum rgb --quiet";
constexpr const char* kSmallSolution = " --spectrum rgb --time-limit 0.02 --quiet";

/// Of pictures; without OpenImageIO one is left.
std::vector<std::string> picture_endings() {
  if (atrium::scene::image_io_available()) return {".pfm", ".exr", ".hdr", ".png", ".jpg"};
  return {".pfm"};
}

// ---- disks ----

// A limit on the size of files that is below what any of them needs; the signal that goes with it
// is ignored, so that writing fails as on a full disk.
TEST_F(Faults, AFullDiskLeavesNoFile) {
  constexpr const char* kLimit = "trap '' XFSZ; ulimit -f 1; ";
  for (const std::string& ending : picture_endings()) {
    SCOPED_TRACE(ending);
    const std::string name = "a" + ending;
    expect_error(with(kLimit, "render room.yaml -o " + name + kSmallPicture), 1, name);
    EXPECT_EQ(files(), "room.yaml ");
  }
  for (const char* ending : {".atrium", ".vtp", ".vtu", ".glb"}) {
    SCOPED_TRACE(ending);
    const std::string name = std::string("a") + ending;
    expect_error(with(kLimit, "solve room.yaml -o " + name + kSmallSolution), 1, name);
    EXPECT_EQ(files(), "room.yaml ");
  }
}

// A file system of 64 kB, where one may be mounted.
TEST_F(Faults, AFullFileSystemLeavesNoFile) {
  const std::filesystem::path mount = folder / "small";
  std::filesystem::create_directories(mount);
  if (::mount("none", mount.c_str(), "tmpfs", 0, "size=64k") != 0)
    GTEST_SKIP() << "no file system may be mounted here";
  for (const std::string& ending : picture_endings()) {
    if (ending == ".jpg" || ending == ".hdr") continue;  // less than 64 kB, or nearly
    const std::string name = "small/a" + ending;
    SCOPED_TRACE(name);
    const Result r = run(folder, "render room.yaml -o " + name +
                                     " --size 400x300 --samples 1 --method direct --spectrum rgb "
                                     "--quiet");
    expect_error(r, 1, name);
    EXPECT_TRUE(std::filesystem::is_empty(mount));
  }
  EXPECT_EQ(::umount(mount.c_str()), 0);
}

TEST_F(Faults, AFolderThatIsNoneOrClosed) {
  folder.write("file", "");
  expect_error(run(folder, std::string("render room.yaml -o file/a.pfm") + kSmallPicture), 2,
               "file/a.pfm");
  expect_error(run(folder, std::string("solve room.yaml -o none/a.atrium") + kSmallSolution), 2,
               "none/a.atrium");
  // Even root may not write here.
  expect_error(run(folder, std::string("render room.yaml -o /proc/a.pfm") + kSmallPicture), 1,
               "/proc/a.pfm");
}

// ---- standard output ----

const std::vector<std::string>& tables() {
  static const std::vector<std::string> all{
      "--version",
      "--help",
      "material list",
      "material list --json",
      "material show Au",
      "info room.yaml",
      "info room.yaml --json",
      "measure room.yaml --spectrum rgb --grid 1,0.8,1 0,0,1 1,0,0 2x2 --time-limit 0.02 --quiet"};
  return all;
}

TEST_F(Faults, TablesThatCannotBeWrittenAreAFailure) {
  for (const std::string& table : tables()) {
    SCOPED_TRACE(table);
    const Result fine = run(folder, table);
    if (fine.code != 0) {
      ADD_FAILURE() << fine.err;
      continue;
    }
    expect_error(run_command(folder, std::string(ATRIUM_PROGRAM) + " " + table + " >/dev/full"), 1,
                 "standard output");
  }
}

// Who closes a pipe wants no more: the program ends by SIGPIPE, or where that is ignored with one
// line.
TEST_F(Faults, AClosedPipeEndsQuietly) {
  for (const std::string& table : tables()) {
    SCOPED_TRACE(table);
    for (const char* before : {"", "trap '' PIPE; "}) {
      const Result r =
          run_command(folder, std::string(before) + "{ sleep 0.2; " + ATRIUM_PROGRAM + " " + table +
                                  " 2>err.txt; echo $? >code.txt; } | true; sleep 0.1; wait");
      const std::string code = read_file(folder / "code.txt");
      EXPECT_EQ(code, *before == '\0' ? "141\n" : "1\n") << r.err;
      const std::string err = read_file(folder / "err.txt");
      EXPECT_LE(std::count(err.begin(), err.end(), '\n'), *before == '\0' ? 0 : 1) << err;
    }
  }
}

// ---- signals ----

struct Job {
  const char* arguments;
  const char* output;
  const char* check;  ///< a command of atrium that succeeds for a complete file
};

// From before main() to after the last file: never half a file, no temporary one.
TEST_F(Faults, SignalsAtAnyMoment) {
  std::vector<Job> jobs{
      {"render room.yaml -o a.pfm --size 200x150 --method path --samples 64 --spectrum rgb --quiet",
       "a.pfm", "compare a.pfm a.pfm"},
      {"solve room.yaml -o a.atrium --spectrum rgb --error 0.002 --quiet", "a.atrium",
       "info a.atrium"},
      {"solve room.yaml -o a.glb --spectrum rgb --quiet", "a.glb", "info a.glb"}};
  if (atrium::scene::image_io_available())
    jobs.push_back({"render room.yaml -o a.png --size 80x60 --quality draft --spectrum rgb --quiet",
                    "a.png", "info a.png"});
  int interrupted = 0, finished = 0;
  for (const Job& job : jobs)
    for (const char* signal : {"INT", "TERM"}) {
      const bool first = *signal == 'I';  // the moments of one signal lie between the other's
      for (const double delay : {0.003, 0.03, 0.1, 0.4}) {
        std::ostringstream line;
        line << "timeout --preserve-status --kill-after=60 -s " << signal << " "
             << (first ? 1.0 : 1.7) * delay << " " << ATRIUM_PROGRAM << " " << job.arguments;
        SCOPED_TRACE(line.str());
        const Result r = run_command(folder, line.str());
        // Until main() has begun signals do what they always do.
        EXPECT_TRUE(r.code == 0 || r.code == 130 || r.code == 143 || r.code >= 1000)
            << r.code << r.err;
        (r.code == 0 ? finished : interrupted) += 1;
        const std::string with_file = std::string(job.output) + " room.yaml ";
        const std::string found = files();
        EXPECT_TRUE(found == "room.yaml " || found == with_file) << found;
        if (found == with_file) {
          EXPECT_EQ(run(folder, job.check).code, 0);
          std::filesystem::remove(folder / job.output);
        } else {
          EXPECT_NE(r.code, 0);
        }
      }
    }
  EXPECT_GT(interrupted, 10);
  RecordProperty("finished", finished);
}

// ---- input ----

// Another program keeps writing the file anew while it is read: whole, short or empty.
TEST_F(Faults, FilesThatChangeWhileTheyAreRead) {
  std::string large = "mtllib none.mtl\n";
  for (int i = 0; i < 20000; ++i)
    large += "v " + std::to_string(i % 141) + " 0 " + std::to_string(i / 141) + "\n";
  for (int i = 0; i + 142 < 20000; ++i)
    large += "f " + std::to_string(i + 1) + " " + std::to_string(i + 2) + " " +
             std::to_string(i + 142) + "\n";
  folder.write("large.obj", large);
  const Result r = run_command(
      folder,
      std::string("cp large.obj a.obj; ( while [ -e go ]; do head -c 300000 large.obj >a.obj; "
                  "cp large.obj a.obj; : >a.obj; cp large.obj a.obj; done ) & touch go; "
                  "for i in 1 2 3 4 5 6 7 8 9 10; do ") +
          ATRIUM_PROGRAM +
          " info a.obj >/dev/null 2>err.txt; echo $?; wc -l <err.txt; done; rm go; wait");
  std::istringstream lines(r.out);
  int code = -1, errors = 0, runs = 0;
  while (lines >> code >> errors) {
    ++runs;
    EXPECT_TRUE(code == 0 || code == 2) << code;
    if (code == 2) {
      EXPECT_EQ(errors, 1);
    }
  }
  EXPECT_EQ(runs, 10) << r.out << r.err;
}

// ---- the machine ----

TEST_F(Faults, AnyNumberOfThreads) {
  const std::string rest = " --size 40x30 --method path --samples 8 --spectrum rgb --quiet";
  ASSERT_EQ(run(folder, "render room.yaml -o 1.pfm --threads 1" + rest).code, 0);
  ASSERT_EQ(run(folder, "render room.yaml -o 64.pfm --threads 64" + rest).code, 0);
  EXPECT_EQ(read_file(folder / "1.pfm"), read_file(folder / "64.pfm"));
}

// Address space from too little to start to enough: success, or one line and code 1.
TEST_F(Faults, LittleMemoryIsOneLine) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers reserve address space of their own";
#else
  int failed = 0;
  for (const int megabytes : {70, 90, 110, 140, 170, 200, 240, 300, 400, 800}) {
    SCOPED_TRACE(megabytes);
    const Result r = with("ulimit -v " + std::to_string(megabytes * 1024) + "; ",
                          "render room.yaml -o a.pfm --size 50x50 --samples 2 --spectrum rgb "
                          "--time-limit 0.3 --threads 2 --quiet");
    if (r.code == 127) continue;  // not even its libraries could be loaded
    if (r.code == 0) {
      std::filesystem::remove(folder / "a.pfm");
      continue;
    }
    ++failed;
    EXPECT_EQ(r.code, 1) << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    EXPECT_EQ(files(), "room.yaml ");
  }
  EXPECT_GT(failed, 0);
#endif
}

// Three quarters of the instructions of a small picture would be that library's loading.
TEST_F(Faults, PicturesWithoutNeedDoNotLoadTheImageLibrary) {
  if (!atrium::scene::image_io_available()) GTEST_SKIP() << "built without OpenImageIO";
  const auto loads = [&](const std::string& name) {
    const Result r = with("LD_DEBUG=files ", "render room.yaml -o " + name + kSmallPicture);
    EXPECT_EQ(r.code, 0);
    return r.err.find("libOpenImageIO") != std::string::npos;
  };
  EXPECT_FALSE(loads("a.pfm"));
  EXPECT_TRUE(loads("a.exr"));
}

// The program alone in a folder finds no module, and says so for what needs one.
TEST_F(Faults, MissingModules) {
  std::filesystem::create_directories(folder / "bin");
  std::filesystem::copy_file(ATRIUM_PROGRAM, folder / "bin/atrium");
  const Result probe =
      run_command(folder, std::string("bin/atrium solve room.yaml -o a.vtp") + kSmallSolution);
  if (probe.code == 0) GTEST_SKIP() << "modules are installed in the configured prefix";
  expect_error(probe, 1, "atrium_mesh_io.so");
  expect_error(
      run_command(folder, std::string("bin/atrium render room.yaml -o a.exr") + kSmallPicture), 1,
      "atrium_image_io.so");
#ifdef ATRIUM_WITH_OPENSUBDIV
  folder.write("cage.yaml",
               "atrium: 1\nmaterials: {m: {body: 0.5}}\nobjects:\n"
               "  - {name: c, material: m, cage: {box: {min: [0, 0, 0], max: [1, 1, 1]}}}\n");
  expect_error(run_command(folder, "bin/atrium info cage.yaml"), 1, "atrium_subdivision.so");
  std::filesystem::remove(folder / "cage.yaml");
#endif
  // What needs none works all the same.
  EXPECT_EQ(
      run_command(folder, std::string("bin/atrium render room.yaml -o a.pfm") + kSmallPicture).code,
      0);
  EXPECT_EQ(
      run_command(folder, std::string("bin/atrium solve room.yaml -o a.atrium") + kSmallSolution)
          .code,
      0);
  EXPECT_EQ(files(), "a.atrium a.pfm bin room.yaml ");
}

}  // namespace
