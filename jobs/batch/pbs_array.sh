#!/bin/bash
#PBS -N study
#PBS -J 1-6
#PBS -l select=1:ncpus=8:mpiprocs=8
#PBS -l walltime=12:00:00
#PBS -j oe
#PBS -r y
# A study: a run for each variant of the job's sweep, in a folder of its own inside the study's.  Submit it
# again until all have ended: those that have do nothing more, the others go on.
# (TORQUE: -t 1-6, -l nodes=1:ppn=8 and $PBS_ARRAYID.)
# Change the lines above (as many elements of the array as `tremie check` lists variants), the wall time also
# here, the job file and the study's folder.
wall=12:00:00
job=jobs/outlet.yaml
study=runs/outlet

cd "$PBS_O_WORKDIR" || exit 2
MACHINE=pbs exec config/launch bin/tremie run "$job" --out "$study" --variant "$PBS_ARRAY_INDEX" --wall "$wall"
