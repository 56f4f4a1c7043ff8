#include "rvelab/io/hdf5_handler.hpp"

#include <hdf5.h>

namespace rvelab::io {

// A handler is of one of two types; HDF5 hands one out only by a call of its own type.
Hdf5Handler::Hdf5Handler() {
  unsigned new_style = 1;
  H5Eauto_is_v2(H5E_DEFAULT, &new_style);
  new_style_ = new_style != 0;
  if (new_style_) {
    H5E_auto2_t handler = nullptr;
    H5Eget_auto2(H5E_DEFAULT, &handler, &argument_);
    call_ = reinterpret_cast<void (*)()>(handler);
  } else {
    H5E_auto1_t handler = nullptr;
    H5Eget_auto1(&handler, &argument_);
    call_ = reinterpret_cast<void (*)()>(handler);
  }
}

Hdf5Handler::~Hdf5Handler() {
  if (new_style_)
    H5Eset_auto2(H5E_DEFAULT, reinterpret_cast<H5E_auto2_t>(call_), argument_);
  else
    H5Eset_auto1(reinterpret_cast<H5E_auto1_t>(call_), argument_);
}

}  // namespace rvelab::io
