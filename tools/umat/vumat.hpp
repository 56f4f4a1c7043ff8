// vumat_: the material of Abaqus/Explicit, in double and in single precision.
#pragma once

namespace umat {

/// Arguments as in Abaqus's manual, by Fortran's rules; arrays of points have nblock rows. Those read: nblock, ndir,
/// nshr, nstatev, nprops, lanneal, stepTime, totalTime, dt, props, density, strainInc, defgradOld, defgradNew,
/// stressOld, stateOld (two numbers a point: id and token), enerInternOld, enerInelasOld. Those written: stressNew,
/// stateNew, enerInternNew, enerInelasNew. density, strainInc and energies may be null; then no energies are written.
/// If props(1) is a float, all arrays are of floats, and id and token take three state variables each.
extern "C" [[gnu::visibility("default")]] void vumat_(
    const int* nblock, const int* ndir, const int* nshr, const int* nstatev, const int* nfieldv, const int* nprops,
    const int* lanneal, const double* stepTime, const double* totalTime, const double* dt, const char* cmname,
    const double* coordMp, const double* charLength, const double* props, const double* density,
    const double* strainInc, const double* relSpinInc, const double* tempOld, const double* stretchOld,
    const double* defgradOld, const double* fieldOld, const double* stressOld, const double* stateOld,
    const double* enerInternOld, const double* enerInelasOld, const double* tempNew, const double* stretchNew,
    const double* defgradNew, const double* fieldNew, double* stressNew, double* stateNew, double* enerInternNew,
    double* enerInelasNew);

}  // namespace umat
