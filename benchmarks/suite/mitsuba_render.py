"""One picture by Mitsuba 3, as a process of its own: SCENE.xml OUT.exr SAMPLES SEED VARIANT."""

import pathlib
import sys


def main():
    scene, out, samples, seed, variant = sys.argv[1:]
    import mitsuba

    mitsuba.set_variant(variant)
    picture = mitsuba.render(mitsuba.load_file(scene), spp=int(samples), seed=int(seed))
    mitsuba.Bitmap(picture).write(out)
    status = pathlib.Path("/proc/self/status").read_text(encoding="utf-8")
    print(int(status.split("VmHWM:")[1].split()[0]) * 1024 / 1e6)


if __name__ == "__main__":
    main()
