# A setting replaces the value of the file before it is looked at.
printf 'slope: 22\nlayers: 2.5\n' >collapse.yaml
talus check --set 'slope=22 deg' --set layers=1 --set erodible_bed_thickness=0 collapse.yaml | head -n 6
