// One member of a struct as a column of a table.
#pragma once

namespace rvelab::records {

/// One member of a struct as a dataset over a list of such structs.
template <class Item, class Member>
struct Column {
  const char* name;
  Member Item::*member;
  const char* units;
};
template <class Item, class Member>
Column(const char*, Member Item::*, const char*) -> Column<Item, Member>;

}  // namespace rvelab::records
