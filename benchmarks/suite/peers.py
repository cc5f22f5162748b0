"""The programs that render the scenes of peer_scenes: is one there, which version, what its materials can say, and a
picture by it."""

import importlib.util
import os
import pathlib
import re
import shutil
import sys

from suite import machine, peer_scenes, program

HERE = pathlib.Path(__file__).resolve().parent
SIZE = (96, 72)


def newest_llvm():
    """Mitsuba's compiled variant takes any LLVM, and fails with one before 17: for its environment."""
    found = {
        int(match.group(1)): str(path)
        for path in pathlib.Path("/usr/lib").glob("*/libLLVM*.so*")
        if (match := re.search(r"libLLVM[^0-9]*([0-9]+)", path.name))
    }
    if not found or "DRJIT_LIBLLVM_PATH" in os.environ:
        return {}
    return {"DRJIT_LIBLLVM_PATH": found[max(found)]}


class Atrium:
    """By radiosity to an asked error, or by path tracing with fixed samples, as other programs have."""

    ending, write = ".yaml", staticmethod(peer_scenes.atrium)
    knows = {peer_scenes.Diffuse, peer_scenes.Metal, peer_scenes.Glass}

    def __init__(self, context, method):
        self.program, self.method, self.name = context.atrium, method, f"Atrium, {method}"
        self.budgets = [0.2, 0.1, 0.05, 0.02] if method == "hybrid" else [4, 16, 64, 256, 1024]
        self.unit = "error asked" if method == "hybrid" else "samples"

    def missing(self):
        return ""

    def version(self):
        return machine.first_line([self.program, "--version"])

    def render(self, file, _scene, budget, seed, out):
        option = "--error" if self.method == "hybrid" else "--samples"
        return program.atrium(
            self.program,
            "render",
            file,
            "-o",
            out,
            "--size",
            f"{SIZE[0]}x{SIZE[1]}",
            "--spectrum",
            "rgb",
            "--method",
            self.method,
            option,
            budget,
            "--seed",
            seed,
        )[0]


class Mitsuba:
    ending, write = ".xml", staticmethod(peer_scenes.mitsuba)
    knows = {peer_scenes.Diffuse, peer_scenes.Metal, peer_scenes.Glass}

    def __init__(self, variant):
        self.variant, self.name = variant, f"Mitsuba 3, {variant}"
        self.budgets, self.unit = [4, 16, 64, 256, 1024], "samples"

    def missing(self):
        if importlib.util.find_spec("mitsuba") is None:
            return "no Python module mitsuba"
        try:
            program.run(
                [
                    sys.executable,
                    "-c",
                    f"import mitsuba; mitsuba.set_variant('{self.variant}'); "
                    "mitsuba.render(mitsuba.load_dict(mitsuba.cornell_box()), spp=1)",
                ],
                environment=newest_llvm(),
            )
        except program.Failed as failure:
            said = [line for line in str(failure).splitlines() if "ERROR" in line or "Error" in line]
            return f"{self.variant} does not run here: " + (said[0][:80] if said else "no reason given")
        return ""

    def version(self):
        return machine.first_line([sys.executable, "-c", "import mitsuba; print(mitsuba.__version__)"])

    def render(self, file, _scene, budget, seed, out):
        cost, text = program.run(
            [sys.executable, HERE / "mitsuba_render.py", file, out, budget, seed, self.variant],
            environment=newest_llvm(),
        )
        cost.memory = float(text.split()[-1])
        return cost


class PovRay:
    """A budget is its radiosity's count of rays; error_bound falls with its root."""

    name, ending, unit = "POV-Ray, radiosity", ".pov", "count"
    budgets = [50, 200, 800]
    write = staticmethod(peer_scenes.pov)
    knows = {peer_scenes.Diffuse, peer_scenes.Glass}

    def missing(self):
        return "" if shutil.which("povray") else "no program povray"

    def version(self):
        return "3.7"

    def render(self, file, _scene, budget, _seed, out):
        values = {"COUNT": budget, "ERROR_BOUND": f"{0.5 * (50 / budget) ** 0.5:.3f}", "RECURSION": 5}
        text = file.read_text(encoding="utf-8")
        for name, value in values.items():
            text = text.replace(name, str(value))
        own = file.with_name(f"{file.stem}-{budget}.pov")
        own.write_text(text, encoding="utf-8")
        return program.run(
            [
                "povray",
                f"+I{own}",
                f"+O{out}",
                "+FE",
                f"+W{SIZE[0]}",
                f"+H{SIZE[1]}",
                "-D",
                "-GA",
                "+A0.0",
                "+AM1",
                "+R2",
            ]
        )[0]


def radiance_folder():
    """Of the package pyradiance, which has Radiance's programs and function files."""
    spec = importlib.util.find_spec("pyradiance")
    return pathlib.Path(spec.origin).parent if spec else None


class Radiance:
    """A budget is the number of ambient divisions; accuracy, resolution and bounces rise with it. Nine rays of a
    pixel, averaged by pfilt."""

    name, ending, unit = "Radiance, rpict", ".rad", "-ad"
    others = {
        64: "-as 16 -aa 0.25 -ar 32 -ab 4",
        256: "-as 64 -aa 0.2 -ar 64 -ab 6",
        1024: "-as 256 -aa 0.15 -ar 64 -ab 8",
    }
    budgets = list(others)
    finer = 3
    write = staticmethod(peer_scenes.radiance)
    knows = {peer_scenes.Diffuse}

    def __init__(self):
        folder = radiance_folder()
        self.environment = (
            {"PATH": f"{folder / 'bin'}:{os.environ['PATH']}", "RAYPATH": str(folder / "lib")}
            if folder and not shutil.which("rpict")
            else {}
        )

    def missing(self):
        path = self.environment.get("PATH")
        lacking = [name for name in ("oconv", "rpict", "pfilt") if not shutil.which(name, path=path)]
        return f"no Python module pyradiance and no program {lacking[0]}" if lacking else ""

    def version(self):
        _, text = program.run(["sh", "-c", "rpict -version"], environment=self.environment)
        return text.strip()

    def render(self, file, scene, budget, _seed, out):
        octree, picture = file.with_suffix(".oct"), out.with_suffix(".hdr")
        view = " ".join(str(w) for w in peer_scenes.radiance_view(scene, [self.finer * n for n in SIZE]))
        cost, _ = program.run(
            [
                "sh",
                "-c",
                f"oconv '{file}' > '{octree}' && rpict -w- {view} -ps 1 -ad {budget} {self.others[budget]} -lr 20 "
                f"-lw 1e-6 -ds 0.1 -dj 0.9 '{octree}' | pfilt -1 -x /{self.finer} -y /{self.finer} > '{picture}'",
            ],
            environment=self.environment,
        )
        return cost


def all_programs(context):
    return [
        Atrium(context, "hybrid"),
        Atrium(context, "path"),
        Mitsuba("scalar_rgb"),
        Mitsuba("llvm_ad_rgb"),
        PovRay(),
        Radiance(),
    ]
