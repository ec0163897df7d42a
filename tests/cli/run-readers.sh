# ncdump and xarray, with both of its engines, read a run file as it is, trailer included
# shellcheck source=tests/cli/small.bash
source "$TALUS_ROOT/tests/cli/small.bash"
if ! command -v ncdump >/dev/null || ! /usr/bin/python3 -c 'import xarray, netCDF4, h5netcdf' 2>/dev/null; then
	echo "skipped: ncdump, or xarray with netCDF4 and h5netcdf, is not installed (see make deps)"
	exit 77
fi
write_small small.yaml
talus run small.yaml --quiet
ncdump -h results/small/run.h5 | sed -E -e '/:(created|cpu_seconds|host|git_revision|compiler|compiler_flags|talus_version) =/d' \
	-e 's/time = [0-9]+ ;/time = N ;/'
cat >read.py <<'END'
import sys
import numpy, xarray
for engine in "netcdf4", "h5netcdf":
    with xarray.open_dataset(sys.argv[1], engine=engine) as run:
        assert run.attrs["status"] == sys.argv[2], run.attrs["status"]
        assert run.attrs["Conventions"] == "CF-1.10"
        assert "layers: 2" in run.attrs["config"]
        assert run.time.dtype == float and run.time.attrs["units"] == "s"
        assert run.front_position.dims == ("time",)
        assert numpy.issubdtype(run.pressure_iterations.dtype, numpy.integer)
        assert all("units" in v.attrs and "long_name" in v.attrs for v in run.variables.values())
        assert run.b.dims == ("x",)
        if sys.argv[2] == "complete":
            assert run.u.dims == ("profile_time", "layer", "x")
            assert run.p.dims == ("profile_time", "interface", "x")
            print(engine, run.profile_time.values, run.sizes["x"], float(run.h.isel(profile_time=-1).max()) > 0)
        else:
            print(engine, run.time.values)
END
/usr/bin/python3 read.py results/small/run.h5 complete
/usr/bin/python3 read.py results/small/run.previous.h5 unfinished
