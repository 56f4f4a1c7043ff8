// umat_: the material of Abaqus/Standard, and of the codes that call it in the same way.
#pragma once

namespace umat {

/// Arguments as in Abaqus's manual, by Fortran's rules. Those read: STRESS (checked on the first call, and for hosts
/// that rotate it), STATEV (two numbers: id and token), STRAN, DSTRAN, TIME(1), DTIME, NDI, NSHR, NTENS, NSTATV, PROPS,
/// NPROPS, DROT, PNEWDT, DFGRD0, DFGRD1, NOEL, NPT. Those written: STRESS, STATEV, DDSDDE, PNEWDT. Arguments that are
/// not needed may be null. Lengths of texts that compilers append are not read.
extern "C" [[gnu::visibility("default")]] void umat_(
    double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd, double* rpl, double* ddsddt,
    double* drplde, double* drpldt, const double* stran, const double* dstran, const double* time, const double* dtime,
    const double* temp, const double* dtemp, const double* predef, const double* dpred, const char* cmname,
    const int* ndi, const int* nshr, const int* ntens, const int* nstatv, const double* props, const int* nprops,
    const double* coords, const double* drot, double* pnewdt, const double* celent, const double* dfgrd0,
    const double* dfgrd1, const int* noel, const int* npt, const int* layer, const int* kspt, const int* kstep,
    const int* kinc);

}  // namespace umat
