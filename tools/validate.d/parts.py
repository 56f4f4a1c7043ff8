"""The parts of tools/validate: what each is, what it costs, needs and runs."""

import dataclasses


@dataclasses.dataclass(frozen=True)
class Part:
    name: str
    minutes: float            # of one core, about; a kept table says what it took
    about: str
    command: str = ""         # for bash in the root, with $program, $work (build/validate), $results, $jobs, $python
    packages: str = ""        # of Debian
    targets: str = ""         # besides rvelab
    needs: str = ""           # of the root
    words: str = ""           # after the folders of a check
    by_name: bool = False     # hours: only by its name or by --stale
    times: bool = False       # compares times: on a machine without other work
    kept: bool = True         # in results
    without_rvelab: bool = False  # its table is of no version

    def run(self):
        return self.command or f"check {self.name} $work/{self.name} {self.words}"


def of_mpm(name, minutes, about, check, words="", **more):
    """Scenes of rvelab-mpm, which share a folder."""
    return Part(name, minutes, about, f"check {check} $work/mpm {words}", targets="rvelab-mpm", **more)


def increments(name, minutes, about, numbers):
    """rvelab-estimates of packings drawn by seed."""
    return Part(name, minutes, about, f"build/release/bin/rvelab-estimates {numbers} $work/{name}",
                targets="rvelab-estimates")


PARTS = [
    Part("kills", 10, "1000 kills, and what is there afterwards",
         "echo '1000 kills (RVELAB_KILLS=1000 build/release/bin/test_kill)'\n"
         "RVELAB_KILLS=1000 build/release/bin/test_kill", targets="test_kill"),
    Part("memory", 20, "memory that runs out at each request of each call of the C interface", targets="test_abi", command=r"""
         RVELAB_MEMORY_STRIDE=1 build/release/bin/test_abi "Without memory*" -s |
           awk '/CHECK_THAT/ {on = 1; print ""} /with message/ {on = 0} on && /requests/ {sub(/^ *"?/, ""); print}
                /^All tests|^test cases/'"""),
    Part("damage", 5, "1000 single flipped bits in each kind of file", targets="rvelab_shared"),
    Part("fuzz", 1000, "sixteen formats; RVELAB_FUZZ_SECONDS for each of them, an hour by default",
         "cmake --preset fuzz >/dev/null\ncmake --build --preset fuzz --parallel $jobs 2>/dev/null | tail -n 1\n"
         "tools/validate.d/fuzz build/release/bin/test_fuzz build/fuzz/bin $work/fuzz ${RVELAB_FUZZ_SECONDS:-3600}",
         packages="clang-14 libclang-rt-14-dev", targets="test_fuzz"),
    Part("exports", 1, "what ParaView and LAMMPS read of rvelab, and rvelab of LAMMPS and YADE",
         "check xdmf $work/exports\ncheck lammps $work/exports\ncheck round_trips $work/exports",
         packages="lammps yade python3-paraview python3-h5py"),
    Part("recording", 1, "what recording costs", "tools/validate.d/recording $program", times=True),
    Part("pack", 10, "void ratio, stress, fabric and time of twenty specimens each", times=True),
    Part("preparation", 20, "void ratios and numbers of contacts that agitated specimens reach; states of Agnolin and Roux",
         targets="rvelab_shared"),
    Part("protocols", 10, "every protocol on the reference packings"),
    Part("control", 60, "what holding a stress costs"),
    Part("held", 120,
         "held stresses through avalanches: 20 specimens of each recipe; RVELAB_BEFORE: another build beside it",
         words="${RVELAB_BEFORE:+--before $RVELAB_BEFORE}"),
    Part("superellipsoids", 4, "contacts of PAIRS pairs (20,000; 1e8 take two weeks of a core)",
         "build/release/bin/rvelab-superellipsoids fuzz ${PAIRS:-20000}", targets="rvelab-superellipsoids"),
    Part("solids", 5, "random packings of ellipsoids without friction"),
    Part("small_strain", 20, "G0 against the pressure by contact law: smooth and rough spheres, cones"),
    Part("thin", 300, "cells sheared to 1e4 at dt > 0, to 300 at dt = 0, and compressed to a Hencky strain of 2"),
    Part("liquefaction", 10, "cycles against the stress ratio"),
    Part("critical_state", 20, "ten dense and ten loose specimens of 1000 discs to gamma = 5"),
    Part("steady_state", 120, "large simple shear beside LAMMPS", needs="../shared/reference/lammps"),
    Part("mu_I", 60, "rheology under a held normal stress: discs, spheres and the spacing of records beside each other", r"""
         status=0 pids=()
         for part in disc sphere none; do
           check mu_I $work/mu_I_$part --only $part >$work/mu_I_$part.txt & pids+=($!)
         done
         for each in "${pids[@]}"; do wait "$each" || status=1; done
         cat $work/mu_I_{disc,sphere,none}.txt
         exit $status"""),
    Part("ellipses", 90, "bedded ellipses: axes of stiffness, strength, shear, fabric"),
    Part("force_fabric", 2, "stress of force and fabric where grains are flat and lie in beds"),
    Part("shapes", 15, "friction angles against elongation and blockiness of grains in space"),
    Part("fit_features", 15, "a published sand fitted by features with five parameters, and a map of densities",
         words="karlsruhe_features"),
    Part("fit_agitated", 25, "the same sand by agitated specimens, the expansion fitted with the rest",
         command="check fit_features $work/fit_agitated karlsruhe_agitated"),
    Part("karlsruhe", 40, "a published sand fitted on three tests and predicted in three"),
    Part("sand", 40, "the recipe of a published sand beside eight tests: five specimens of 1,000 grains"),
    Part("sand_variants", 10, "rough contacts, and clumps, agitated as that recipe, beside its drained tests"),
    Part("ottawa", 10, "cycles to liquefaction of a second sand, predicted from its limits of density, critical angle and G0"),
    Part("sheet", 20, "data sheets of two sands by the quick plan, beside published numbers"),
    Part("study", 5, "errors and their estimates over the tolerances", "check studies $work/study tolerance"),
    Part("studies", 60, "studies of scale: space, number of grains, stiffness over pressure; and of damping"),
    increments("estimates", 60,
               "increments of packings drawn by seed, RVELAB_INCREMENTS (28) of each of three states of 36",
               "2 37 ${RVELAB_INCREMENTS:-28}"),
    Part("constants", 60, "what each constant of quasi-static loading is worth on increments of estimates",
         words="$work/estimates"),
    increments("estimates_long", 20, "increments of 1e-3 to 1e-2 of the kinds that fell short outside", "111 120 7"),
    increments("estimates_interactions", 3,
               "increments of cemented and moist packings, before, while and after bonds break", "221 270 4"),
    increments("estimates_shapes", 10, "increments of clumps, ellipsoids, superellipsoids and mixtures", "321 370 4"),
    increments("estimates_all", 20, "every error, of chaotic increments too, on seventy packings never fitted",
               "620 689 10"),
    Part("pieces", 20, "one path, whole and in pieces of 1e-7, with turns", targets="rvelab-pieces", times=True),
    Part("starts", 5, "a path of 1e-3, from rest, going on and back, in up to 10,000 pieces", targets="rvelab-starts",
         times=True,
         command="packings starts dense hertz\nbuild/release/bin/rvelab-starts $work/starts/{dense,hertz}.h5"),
    Part("orders", 20, "orders of the time step and of the loading rate", targets="rvelab-orders",
         command="packings orders dense hertz\nbuild/release/bin/rvelab-orders $work/orders/{dense,hertz}.h5"),
    Part("package", 90, "all packages in bare systems: installed, used, removed without a trace", packages="debootstrap", command="""
         tools/package $work/packages >$work/packages.log 2>&1 || { tail -n 20 $work/packages.log >&2; exit 1; }
         sed -n '/^package: /,$p' $work/packages.log
         tools/validate.d/package $work/packages $work/bare_systems"""),
    Part("arm64", 40, "the program for arm64, run by qemu, has the bits of the native one",
         "tools/validate.d/arm64 $program $work/arm64",
         packages="debootstrap"),
    Part("bare", 60, "the two commands of README.md in a bare Debian 12", packages="debootstrap", times=True, command=r"""
         tools/validate.d/bare $work/bare \
           'SECONDS=0; tools/quickstart 2>&1 | tail -n 12; echo "tools/quickstart: exit code 0 after $SECONDS s, installation and build included"' \
           'SECONDS=0; tools/test 2>&1 | tail -n 4; echo "tools/test: exit code 0 after $SECONDS s more"'"""),
    Part("stress", 60, "all cases of tests/extreme, and LAMMPS; RVELAB_STRESS_JSON: a file that they wrote before",
         packages="lammps",
         targets="test_extreme",
         command="check stress_peers $work/stress ${RVELAB_STRESS_JSON:+--json $RVELAB_STRESS_JSON}", times=True),
    Part("peers", 20, "grain-steps a second, and a biaxial test as users run it",
         "tools/bench/peers $program && tools/bench/biaxial $program",
         times=True, kept=False),
    Part("interactions_peers", 45,
         "bonds and bridges beside YADE and LAMMPS; RVELAB_LAMMPS: one with BPM and GRANULAR, else it is built",
         "check interactions_peers $work/interactions_peers ${RVELAB_LAMMPS:-}\n"
         "tools/bench/interactions $program ${RVELAB_LAMMPS:-$work/interactions_peers/lammps/src/lmp_serial}",
         packages="yade make xz-utils", targets="rvelab_shared", times=True),
    Part("yade_increments", 60, "error against processor time of an increment, from states of YADE's packings",
         packages="yade",
         targets="rvelab-increments", needs="../shared/reference/yade/packings", times=True),
    Part("fit_schemes", 10, "schemes of inverse calibration on a synthetic material", packages="python3-scipy",
         without_rvelab=True),
    Part("fit", 60, "hidden parameters of real tests"),
    Part("fit_triaxial", 10, "GrainLearning's triaxial test on its packing, with its parameters and fitted"),
    Part("scatter", 20, "how scatter falls with specimens and grains"),
    Part("ensembles", 15, "20 specimens of each published recipe; 45 tests by one command, killed and resumed",
         times=True),
    Part("bands", 3, "acoustic tensor and second-order work through a biaxial test"),
    Part("batch", 5, "speed of batches", "tools/bench/batch $program", times=True, kept=False),
    Part("scaling", 10, "speed on threads", "tools/bench/scaling $program && cat tools/bench/scaling.md", times=True,
         kept=False),
    Part("features", 10, "speed of features", "tools/bench/features $program", times=True, kept=False),
    Part("capillary", 1, "laws of liquid bridges against the Young-Laplace equation",
         words="compare tests/data/interaction/young_laplace.csv", without_rvelab=True),
    Part("cemented", 5,
         "cemented grains, ensembles of five: strength, envelopes, breaking beside published statements"),
    Part("moist", 10, "moist grains, ensembles of five: strength against suction, collapse on wetting"),
    Part("new_law", 8, "one more law of an interaction, in a copy of the tree: files to touch, and its tests"),
    Part("sanitizers", 180, "the quick tests under the sanitizers of addresses, undefined behaviour and threads", targets="test_extreme", command="""
         for preset in asan-ubsan tsan; do
           cmake --preset $preset
           cmake --build --preset $preset --parallel $jobs
         done 2>&1 | tail -n 2
         # Their runtime looks for libraries in folders of its own; and an uninstrumented host cannot load them.
         LD_LIBRARY_PATH=$PWD/build/asan-ubsan/lib ctest --preset asan-ubsan --parallel $jobs -LE matrix -E "Installed and moved" | tail -n 6
         build/tsan/bin/test_solver "*batch*","*Workers*","*team*" | tail -n 3
         LD_LIBRARY_PATH=$PWD/build/tsan/lib build/tsan/bin/test_abi "*at once*","*busy*","*workers*","*tasks*" | tail -n 3
         # What is freed is kept aside for a while, to be found if it is used: less of it, so that the limits on memory
         # hold.
         ASAN_OPTIONS=quarantine_size_mb=16:thread_local_quarantine_size_kb=64 same_stresses asan-ubsan 1"""),
    Part("unoptimised", 60, "the quick cases of tests/extreme have their outcomes and bits without optimisation too",
         targets="test_extreme",
         command="""
         cmake --preset dev -B build/unoptimised -D CMAKE_CXX_FLAGS_DEBUG=-O0 | tail -n 1
         cmake --build build/unoptimised --parallel $jobs --target test_extreme | tail -n 1
         same_stresses unoptimised 60"""),
    Part("bits", 3, "every result against hashes that are kept; tools/validate.d/bits.py ... --write keeps new ones",
         "$python tools/validate.d/bits.py $program $work/bits tools/validate.d/results/bits.json", targets="test_extreme"),
    of_mpm("mpm", 5, "speed of the continuum, and the single element", "mpm", times=True),
    of_mpm("mpm_biaxial", 180, "compression over four meshes; RVELAB_MPM_CASES: others (C1: the file without a case)",
           "mpm",
           "biaxial ${RVELAB_MPM_CASES:-M1 C4 M4 F4}", by_name=True),
    Part("mpm_damage", 10, "1000 single flipped bits in each file that rvelab-mpm reads back", targets="rvelab-mpm"),
    Part("mpm_energy", 50, "1000 mutated scenes: none may end well with energy from nothing", targets="rvelab-mpm"),
    Part("mpm_fluid", 1, "saturated elastic soil against exact solutions", targets="test_mpm", command=r"""
         echo "what                                                                          value      target               verdict"
         build/release/bin/test_mpm "[saturated]" | grep -E " (ok|MISSED)$|^All tests|^test cases" """),
    Part("mpm_threads", 5, "what threads share of a step with three bodies", packages="valgrind", targets="rvelab-mpm",
         times=True),
    Part("mpm_busy", 5, "one thread and all of them, beside as many busy loops as cores", targets="rvelab-mpm",
         times=True),
    Part("mpm_contact", 1, "contact with bodies at nodes and at their surface", targets="rvelab-mpm"),
    of_mpm("mpm_tolerance", 15, "error of coupled runs against grain-steps", "mpm", "tolerance"),
    of_mpm("mpm_rocks", 30, "balls, a block on a slope, one that floats, boulders, what rocks cost", "mpm_rocks",
           times=True),
    of_mpm("mpm_mixture", 90, "a softening soil and mixtures with rocks between plates", "mpm_mixture",
           packages="python3-scipy"),
    of_mpm("mpm_grains", 90, "mixtures with every grain as a rock, and with the fine ones as points", "mpm_grains"),
    of_mpm("mpm_soil_rock", 45, "soil with rocks of three sizes at three pressures", "mpm_soil_rock"),
    of_mpm("mpm_rocks_in_grains", 20, "discs ten times as large as the grains, beside RVEs and among grains",
           "mpm_rocks_in_grains"),
    of_mpm("mpm_footing", 50, "load against settlement on five specimens of three soils beside their N_q",
           "mpm_scenes", "footing"),
    of_mpm("mpm_footing_published", 105, "the same at the published size, soft soil to d/B = 0.45, dense to 0.1",
           "mpm_scenes",
           "footing_published", by_name=True),
    of_mpm("mpm_footing_published_5", 40, "dense soil whose strength is the published one, at the published size",
           "mpm_scenes",
           "footing_published_5", by_name=True),
    of_mpm("mpm_column", 35, "collapse of columns of a Mohr-Coulomb soil and of grains", "mpm_scenes", "column"),
    of_mpm("mpm_column_published", 150, "that of grains at the published size", "mpm_scenes", "column_published",
           by_name=True),
    of_mpm("mpm_pipe", 24, "a pipe pushed into sand", "mpm_scenes", "pipe"),
    of_mpm("mpm_pipe_soil", 1, "the same in Mohr-Coulomb soil over three meshes and two strengths", "mpm_scenes",
           "pipe_soil"),
    of_mpm("mpm_fluid_scenes", 105,
           "saturated grains beside exact answers, tests of their specimen and published figures; "
           "RVELAB_MPM_COLUMN, RVELAB_MPM_WAVE: more options of rvelab-mpm", "mpm_fluid_scenes"),
    of_mpm("mpm_shaking", 300,
           "the shaken box, two soils and two seeds; RVELAB_MPM_SHAKING: more options of rvelab-mpm",
           "mpm_fluid_scenes",
           "shaking", by_name=True),
    Part("calculix", 15, "CalculiX with RVEs in its points; built from Debian's source", targets="rvelab_umat",
         times=True,
         packages="gfortran make dpkg-dev libarpack2-dev libspooles-dev liblapack-dev"),
    Part("fenicsx_biaxial", 30, "finite elements with RVEs, to a band of shear, over three meshes", targets="rvelab_shared",
         packages="python3-dolfinx python3-dolfinx-real openmpi-bin", command="check fenicsx $work/fenicsx biaxial"),
    Part("fenicsx_footing", 45, "the same under a strip footing, beside N_q and Mohr-Coulomb points", targets="rvelab_shared",
         packages="python3-dolfinx python3-dolfinx-real openmpi-bin", command="check fenicsx_capacity $work/fenicsx footing"),
    Part("fenicsx_thousand", 60, "968 points to 3 % of strain through the peak, on one rank and on two",
         targets="rvelab_shared", packages="python3-dolfinx python3-dolfinx-real openmpi-bin",
         command="check fenicsx $work/fenicsx thousand"),
    Part("fenicsx_published", 10, "the biaxial test of Guo and Zhao by the inputs of YADE's scripts; nothing published is compared", targets="rvelab_shared",
         packages="python3-dolfinx python3-dolfinx-real openmpi-bin", command="check fenicsx $work/fenicsx published"),
    Part("fenicsx_wall", 20, "a retaining wall beside Rankine and Coulomb", targets="rvelab_shared",
         packages="python3-dolfinx python3-dolfinx-real openmpi-bin", command="check fenicsx_capacity $work/fenicsx wall"),
    Part("fenicsx_scaling", 10, "work and messages of finite elements with RVEs on 1 to 16 ranks", targets="rvelab_shared",
         packages="python3-dolfinx python3-dolfinx-real openmpi-bin", command="check fenicsx $work/fenicsx scaling"),
    Part("fenicsx_yade", 10, "a trial of an RVE in finite elements by YADE's FEMxDEM coupling and by rvelab.fenicsx",
         targets="rvelab_shared rvelab-increments", packages="yade", needs="../shared/reference/yade/packings", times=True),
    Part("report", 1, "pictures of report pages and how fast they open, in Chromium", packages="chromium",
         targets="rvelab-mpm", times=True),
    Part("wasm", 30,
         "the laboratory as WebAssembly has the bits of the native program; emscripten, node, npm's registry",
         "tools/web/build && tools/web/check-bits", targets="rvelab-end-state", by_name=True, kept=False),
]
BY_NAME = {part.name: part for part in PARTS}

# What the commands above call.
FUNCTIONS = r"""
set -euo pipefail
check() { $python "tools/validate.d/$1.py" "$program" "$2" "$results" "${@:3}"; }
# packings FOLDER NAME...: of the recipes pack_NAME.
packings() {
  mkdir -p "$work/$1"
  for each in "${@:2}"; do "$program" pack "pack_$each" -o "$work/$1/$each.h5" --force >/dev/null; done
}
# same_stresses BUILD PATIENCE: the quick cases of tests/extreme of build/BUILD beside those of the release build.
same_stresses() {
  RVELAB_CASES=quick RVELAB_JSON=$work/release.json build/release/bin/test_extreme "the matrix" || true
  RVELAB_CASES=quick RVELAB_PATIENCE=$2 RVELAB_JSON=$work/$1.json "build/$1/bin/test_extreme" "the matrix" || true
  $python tools/validate.d/builds.py "$work/release.json" "$work/$1.json"
}
"""
