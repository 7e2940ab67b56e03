# SPDX-License-Identifier: BSD-3-Clause
# The chain of mremesh as a Makefile: one rule a stage, its result kept in NAME.stages (under the names of mremesh --keep), so
# that only what changed is done again, and several surfaces at the same time.
#
#   make -j -f scripts/remesh.mk aorta.mesh.vtu SIZE=0.8
#   make -j -f scripts/remesh.mk aorta.mesh.vtu lung.mesh.stl TRIANGLES=50000 FLAGS=-v
#
# EXT is vtu, vtp, vtk, stl, obj, off, ply, msh, msh2, msh4, mesh, meshb, gts, inp, bdf, nas or poly; NAME has no blanks.
# NAME.mesh.EXT is made from NAME.stl, .obj, .off, .ply, .msh, .vtu, .vtp, .vtk, .mesh or .meshb, whichever is there first.
# Where the result misses its contract, sizes are made smaller there and the chain is repeated from msize on, as mremesh does:
# in NAME.stages/again.
#   SIZE, TRIANGLES      what mremesh takes as --size and --triangles (default: about as many triangles as the input has)
#   BOUNDS               --min, --max and --gradation, which hold for smaller sizes, too
#   CLEAN_ARGS, FEATURE_ARGS, PARTITION_ARGS, ... CHECK_ARGS
#                        further options of a stage's program: FEATURE_ARGS='--feature-angle none'
#   FLAGS                options of all programs (default -q)

FLAGS ?= -q
inputs := stl obj off ply msh vtu vtp vtk mesh meshb
outputs := vtu vtp vtk stl obj off ply msh msh2 msh4 mesh meshb gts inp bdf nas poly
# the stages in order, from size on also in later rounds
names := clean topo feature coarsen partition multiscale param size lines mesh2d lift relax check
stages := $(shell n=0; for s in $(names); do n=$$((n + 1)); printf '%02d-%s ' $$n $$s; done)
later := $(shell echo $(names) | sed 's/.* size //; s/ check//')
numbered = $(filter %-$(1),$(stages))
mapped := $(call numbered,param)
last := $(lastword $(filter-out %-check,$(stages)))

# sizes that vary have no share for the tolerance of mfeature, as in mremesh
varying := $(foreach o,--data --field --expression --around --across --gap,$(findstring $(o),$(SIZE_ARGS)))
tolerance := $(if $(strip $(varying)),$(if $(findstring --tolerance,$(FEATURE_ARGS)),,--tolerance 0))
# nor do they say how coarse a surface may be
smaller := $(varying) $(foreach o,--curvature --chord --max,$(findstring $(o),$(SIZE_ARGS) $(BOUNDS)))
coarsen := $(if $(strip $(smaller)),,COARSEN)
goal := $(if $(SIZE),--size $(SIZE)) $(if $(TRIANGLES),--triangles $(TRIANGLES))
# all options of a stage, by its name in capitals
args = $(strip $($(1)_ARGS) $(if $(filter FEATURE SIZE $(coarsen),$(1)),$(goal)) $(if $(filter SIZE,$(1)),$(BOUNDS)) \
  $(if $(filter FEATURE COARSEN,$(1)),$(findstring --keep-boundary,$(LINES_ARGS))) $(if $(filter FEATURE,$(1)),$(tolerance)) $(if $(filter RELAX,$(1)),--accept))
# make -n shows what it would do, and runs nothing
dry := $(findstring n,$(firstword -$(MAKEFLAGS)))

# programs of this build first
this := $(abspath $(lastword $(MAKEFILE_LIST)))
here := $(dir $(abspath $(lastword $(MAKEFILE_LIST))))
programs := $(firstword $(dir $(wildcard $(here)mclean $(here)../bin/mclean $(here)../build/bin/mclean)))
export PATH := $(if $(programs),$(programs):)$(PATH)
ifeq ($(shell PATH='$(PATH)'; command -v mclean),)
  $(error the programs of meshpipe are neither in $(here)../build/bin nor on PATH: build them, as scripts/demo does)
endif

.SUFFIXES:
.SECONDARY:
.DELETE_ON_ERROR:
.PHONY: FORCE again
FORCE:

# make takes a name with a blank for two
parts := $(filter-out $(foreach e,$(outputs),%.mesh.$(e)) %.ply %.options again,$(MAKECMDGOALS))
ifneq ($(parts),)
  $(error '$(firstword $(parts))' is no NAME.mesh.EXT, where EXT is one of: $(outputs); and NAME has no blanks)
endif

# NAME.stages is one run's at a time, as for mremesh --keep; a lock does not hold once its process has ended
%.stages/lock: FORCE
	@mkdir -p $(@D); (set -C; echo $$PPID >$@) 2>/dev/null || ! kill -0 "$$(cat $@)" 2>/dev/null || \
	  { echo "$(@D): another run is at work there, process $$(cat $@)" >&2; exit 1; }; echo $$PPID >$@

upper = $(shell printf %s '$(1)' | tr a-z A-Z)
name_of = $(word 2,$(subst -, ,$(1)))
# the options of a stage are a file too, which is written when they change
define options
%.stages/$(1).options: FORCE | %.stages/lock
	@printf '%s\n' '$$(call args,$(2))' | cmp -s - $$@ || printf '%s\n' '$$(call args,$(2))' >$$@
endef
$(foreach s,$(stages),$(eval $(call options,$(s),$(call upper,$(call name_of,$(s))))))

# the input is known by its checksum, too: another one may be older
define clean
%.stages/input: %.$(1) FORCE | %.stages/lock
	@sum=$$$$(cksum <$$<); [ "$$$$sum" = "$$$$(cat $$@ 2>/dev/null)" ] || printf %s "$$$$sum" >$$@
%.stages/$(call numbered,clean).ply: %.$(1) %.stages/$(call numbered,clean).options %.stages/input
	mclean $$(FLAGS) $$(call args,CLEAN) $$< -o $$@
endef
$(foreach e,$(inputs),$(eval $(call clean,$(e))))

# stage, the one before it, its program, its options
define stage
%.stages/$(1).ply: %.stages/$(2).ply %.stages/$(1).options
	$(3) $$(FLAGS) $$(call args,$(4)) $$< -o $$@
endef
previous := $(call numbered,clean)
$(foreach s,$(filter-out %-clean %-check,$(stages)),\
  $(eval name := $(call name_of,$(s)))\
  $(eval $(call stage,$(s),$(previous),m$(name),$(call upper,$(name))))\
  $(eval previous := $(s)))

# mcheck of a stem's mesh into a result; it says in the verdict what is next
check = mcheck $(FLAGS) $(call args,CHECK) --json $(1).stages/$(call numbered,check).json --verdict $(1).stages/verdict \
  --refine $(1).stages/refined.ply $(2) -o $(3) || \
  $(MAKE) --no-print-directory -f $(this) again STEM='$(1)' RESULT='$(3)'

define result
%.mesh.$(1): %.stages/$(last).ply %.stages/$(call numbered,check).options
	@rm -f $$*.stages/verdict
	$(if $(dry),,+)$$(call check,$$*,$$<,$$@)
endef
$(foreach e,$(outputs),$(eval $(call result,$(e))))

# one more round, if the verdict asks for it; a number of triangles holds as long as it says
dir := $(STEM).stages
# stage $(1) of that round, after `previous`
define repeat
$(eval name := $(call name_of,$(1)))m$(name) $(FLAGS) $(call args,$(call upper,$(name))) \
  $(dir)/again/$(previous).ply -o $(dir)/again/$(1).ply$(eval previous := $(1))

endef
again:
	@[ -e $(dir)/verdict ]
	@tail -n 1 $(dir)/verdict | grep -qx next=refine || \
	  { sed -n 's/^message=/mcheck: error: /p' $(dir)/verdict | tail -n 1 >&2; exit 1; }
	@mkdir -p $(dir)/again; mv $(dir)/refined.ply $(dir)/again/field.ply
	msize $(FLAGS) $(if $(SIZE),--size $(SIZE)) $(if $(TRIANGLES),$$(tail -n 2 $(dir)/verdict | \
	  grep -qx count=free || echo --triangles $(TRIANGLES))) $(BOUNDS) --field $(dir)/again/field.ply:size \
	  $(dir)/$(mapped).ply -o $(dir)/again/$(call numbered,size).ply
	$(eval previous := $(call numbered,size))$(foreach n,$(later),$(call repeat,$(call numbered,$(n))))
	$(if $(dry),,+)$(call check,$(STEM),$(dir)/again/$(last).ply,$(RESULT))
