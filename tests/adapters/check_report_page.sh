#!/bin/sh
# check_report_page.sh FOLDER: whether page.html there is what src makes. Exit code 77: it cannot be told here.
if ! command -v npm > /dev/null || [ ! -d "$1/node_modules" ]; then
  echo "not run: it needs npm and $1/node_modules (npm ci there)"
  exit 77
fi
exec "$1/build" --check
