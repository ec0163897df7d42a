# A bad --set cites itself instead of the file, after which the file is as good as before.
printf 'slope: 22 deg\nerodible_bed_thickness: 1.82 mm\nlayers: 10\n' >collapse.yaml
for setting in layers layers= =3 '' layer=3 domain.cell=3 cells=3 tme.cfl=1 colour=red \
	layers=2.5 slope=22 initial.height=nan initial.height=3s time.cfl=7 pressure_solver.norm=l3 \
	domain=3 'layers=[3]' 'layers={a: 3}' 'layers=*a' 'layers=[3' $'layers=3\n---\n4' \
	n_ini_guess=3 layers=1=1 'output.profiles_at=3 s' 'output.profiles_at=[0.32 s, 3.5 s]' \
	rheology.mu_s=0.9 domain.x_max=-1 domain.x_min=0.5 "layers=$(printf '9%.0s' {1..400})"; do
	talus check --set "$setting" collapse.yaml
	[[ $? == 65 ]] || echo "exit code of $setting"
done
talus check --set n_ini_guess=4 --set layers=8 -s 'output.profiles_at=[0.32 s, 3 s]' \
	--set 'domain={cells: 20, x_max: 1.5 m}' collapse.yaml | grep -e layers -e n_ini -e profiles -e cells -e x_max
