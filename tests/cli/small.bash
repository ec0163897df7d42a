# What the cases about runs share. Sourced, not run.

# A config that runs in a fraction of a second.
write_small() # FILE
{
	cat >"$1" <<-'END'
		slope: 22 deg
		erodible_bed_thickness: 2 mm
		layers: 2
		n_ini_guess: 0
		domain: {x_min: -0.1 m, x_max: 0.3 m, cells: 20}
		initial: {height: 0.05 m, front: 0 m}
		time: {end: 0.3 s}
		output: {profiles_at: [0.1 s]}
	END
}

# What differs between two runs of a case: clocks, the build and the machine.
clocks()
{
	sed -E -e 's/[0-9.]+ s of CPU time/T s of CPU time/' -e 's/(CPU time +)[0-9.]+ s/\1T s/' \
		-e 's/[0-9-]{10}T[0-9:]{8}Z/STAMP/' -e 's/process [0-9]+ on [^ ]+/process P on HOST/' \
		-e 's/^(  (host|talus_version|git_revision|compiler) +).*/\1.../' -e 's/(size +)[0-9.]+ kB/\1S kB/'
}
