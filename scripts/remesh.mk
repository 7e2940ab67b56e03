# SPDX-License-Identifier: BSD-3-Clause
# The chain of mremesh as a Makefile: one rule a stage, its result kept in NAME.stages (under the names of mremesh --keep), so
# that only what changed is done again, and several surfaces at the same time.
#
#   make -j -f scripts/remesh.mk aorta.mesh.vtu SIZE=0.8
#   make -j -f scripts/remesh.mk aorta.mesh.vtu lung.mesh.stl TRIANGLES=50000 FLAGS=-v
#
# EXT is vtu, vtp, vtk, stl, obj, off, ply, msh, msh2, msh4, mesh, meshb, gts, inp, bdf, nas or poly; NAME has no blanks.
# NAME.mesh.EXT is made from NAME.stl, .obj, .off, .ply, .msh, .vtu, .vtp, .vtk, .mesh or .meshb, whichever is there first.
#   SIZE, TRIANGLES      what mremesh takes as --size and --triangles (default: as many triangles as the input has)
#   CLEAN_ARGS, FEATURE_ARGS, PARTITION_ARGS, ... CHECK_ARGS
#                        further options of a stage's program: FEATURE_ARGS='--feature-angle none'
#   FLAGS                options of all programs (default -q)

FLAGS ?= -q
inputs := stl obj off ply msh vtu vtp vtk mesh meshb
outputs := vtu vtp vtk stl obj off ply msh msh2 msh4 mesh meshb gts inp bdf nas poly
stages := 01-clean 02-topo 03-feature 04-partition 05-multiscale 06-param 07-size 08-lines 09-mesh2d 10-lift 11-relax

goal := $(if $(SIZE),--size $(SIZE))$(if $(TRIANGLES),--triangles $(TRIANGLES))
# all options of a stage, by its name in capitals
args = $(strip $($(1)_ARGS) $(if $(filter FEATURE SIZE,$(1)),$(goal)))

# programs of this build first
here := $(dir $(abspath $(lastword $(MAKEFILE_LIST))))
programs := $(firstword $(dir $(wildcard $(here)mclean $(here)../bin/mclean $(here)../build/bin/mclean)))
export PATH := $(if $(programs),$(programs):)$(PATH)
ifeq ($(shell PATH='$(PATH)'; command -v mclean),)
  $(error the programs of meshpipe are neither in $(here)../build/bin nor on PATH: build them, as scripts/demo does)
endif

.SUFFIXES:
.SECONDARY:
.DELETE_ON_ERROR:
.PHONY: FORCE
FORCE:

# make takes a name with a blank for two
parts := $(filter-out $(foreach e,$(outputs),%.mesh.$(e)) %.ply %.options,$(MAKECMDGOALS))
ifneq ($(parts),)
  $(error '$(firstword $(parts))' is no NAME.mesh.EXT, where EXT is one of: $(outputs); and NAME has no blanks)
endif

upper = $(shell printf %s '$(1)' | tr a-z A-Z)
# the options of a stage are a file too, which is written when they change
define options
%.stages/$(1).options: FORCE
	@mkdir -p $$(@D); printf '%s\n' '$$(call args,$(2))' | cmp -s - $$@ || printf '%s\n' '$$(call args,$(2))' >$$@
endef
$(foreach s,$(stages) 12-check,$(eval $(call options,$(s),$(call upper,$(word 2,$(subst -, ,$(s)))))))

define clean
%.stages/01-clean.ply: %.$(1) %.stages/01-clean.options
	mclean $$(FLAGS) $$(call args,CLEAN) $$< -o $$@
endef
$(foreach e,$(inputs),$(eval $(call clean,$(e))))

# stage, the one before it, its program, its options
define stage
%.stages/$(1).ply: %.stages/$(2).ply %.stages/$(1).options
	$(3) $$(FLAGS) $$(call args,$(4)) $$< -o $$@
endef
previous := 01-clean
$(foreach s,$(filter-out 01-clean,$(stages)),\
  $(eval name := $(word 2,$(subst -, ,$(s))))\
  $(eval $(call stage,$(s),$(previous),m$(name),$(call upper,$(name))))\
  $(eval previous := $(s)))

define result
%.mesh.$(1): %.stages/11-relax.ply %.stages/12-check.options
	mcheck $$(FLAGS) $$(call args,CHECK) --json $$*.stages/12-check.json $$< -o $$@
endef
$(foreach e,$(outputs),$(eval $(call result,$(e))))
